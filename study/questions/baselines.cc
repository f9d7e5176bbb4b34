#include "study/questions/baselines.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "base/shell_quoted.h"
#include "proto/json_text.h"
#include "search/given/repeated_case.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kNamedBaselines = 3;
constexpr const char* kOnlyOne = "without obstacles";

Experiment BaselineOf(const Experiment& experiment) {
  return ConfirmationOf(experiment, kBaselineRuns);
}

Result<QuestionedCampaign> EmptyArenas(const Asking& asking) {
  TRY(auto questioned, CasesOfRuns(asking.place, {}));
  for (std::size_t i = 0; i < questioned.plans.size(); ++i) {
    SearchPlan& plan = questioned.plans[i];
    if (RowOf(plan.experiment).varies_settings)
      return InvalidInput(asking.place +
                          ": its runs have different settings, each with an empty arena of its own");
    // Searches that differ in their seeds alone share one.
    plan.experiment.seed = questioned.plans.front().experiment.seed;
    questioned.cases.push_back(
        {plan.settings.empty() ? kOnlyOne : plan.settings, i, EmptyArena(plan.experiment.arena)});
  }
  return questioned;
}

Result<Experiment> AboutBaseline(const Experiment& experiment, const Asking& /*asking*/) {
  return BaselineOf(experiment);
}

std::string Of(const Baseline& one) {
  const std::string count = fmt::format("{} of {} runs", one.tally.failures, one.tally.runs());
  return one.settings.empty() ? count : fmt::format("{} ({})", count, Printable(one.settings));
}

Result<Told> TellBaseline(const Asking& asking, const Call& /*call*/,
                          std::span<const CaseAnswer> /*answers*/) {
  TRY(const std::vector<Baseline> baselines, ReadBaselines(asking.place));
  const Table table = BaselinesTable(baselines);
  Told told{.section = {.table = table}, .json = JsonText({{"baselines", table.ToJson()}})};
  told.section.sentences = {InWords(baselines, asking.program, asking.place)};
  return told;
}

constexpr const char* kBaselineHelp =
    R"(Simulates the swarm 20 times in the arena without obstacles, with seeds that no search has. A swarm that fails
there too may fail in a case for reasons that have nothing to do with its obstacles, so whatever tells of failures
says this first. 'evolve', 'random', 'resume' and 'confirm' look by themselves; this command looks for campaigns that
ran on a cluster, or before. What is known is kept in DIR/baseline, and changes nothing of the campaign.

Examples:
  gauntlet baseline DIR
  gauntlet baseline DIR --json)";

// "0 of 20 runs under each of 7 settings", or the first of them one by one.
std::string CountsOf(const std::vector<Baseline>& baselines) {
  const auto counts = [](const Baseline& one) { return std::pair(one.tally.failures, one.tally.runs()); };
  const auto [failures, runs] = counts(baselines.front());
  if (baselines.size() > 1 &&
      std::ranges::count(baselines, counts(baselines.front()), counts) == std::ssize(baselines))
    return fmt::format("{} of {} runs under each of {} settings", failures, runs, baselines.size());
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamedBaselines, baselines.size()); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : ", ", Of(baselines[i]));
  if (baselines.size() > kNamedBaselines)
    text += fmt::format(" and {} more", baselines.size() - kNamedBaselines);
  return text;
}

}  // namespace

double Baseline::Share() const {
  return tally.runs() == 0 ? 0.0 : static_cast<double>(tally.failures) / tally.runs();
}

bool HasBaseline(const std::string& search) {
  const SearchRow* row = FindSearch(search);
  return row != nullptr && !row->given_cases() && !row->varies_settings;
}

Result<std::vector<Baseline>> ReadBaselines(const std::string& dir) {
  TRY(const auto answers, AnswersOfCalls(FolderOf(BaselineQuestion(), dir), KeyOfCase));
  std::vector<Baseline> baselines;
  for (const CaseAnswer& one : BestOf(answers))
    baselines.push_back({one.name == kOnlyOne ? "" : one.name, one.tally()});
  if (baselines.size() == 1) baselines.front().settings.clear();
  std::ranges::stable_sort(baselines, std::greater(), &Baseline::Share);
  return baselines;
}

Table BaselinesTable(const std::vector<Baseline>& baselines) {
  Table table({{"settings", "settings"}, {">failed", "k n"}, {"probability (95 %)", "interval"}});
  for (const Baseline& one : baselines)
    table.AddRow({one.settings.empty() ? Cell("the experiment's", TextValue("")) : Cell(one.settings),
                  OutOfCell(one.tally.failures, one.tally.runs()), PercentCell(FailureInterval(one.tally))});
  return table;
}

bool Matters(const std::vector<Baseline>& baselines) {
  return !baselines.empty() && baselines.front().Share() >= 0.1;
}

std::string InWords(const std::vector<Baseline>& baselines, const std::string& program,
                    const std::string& dir) {
  if (baselines.empty())
    return fmt::format("How often it fails without any obstacle is not known: {} baseline {} looks.", program,
                       PastedPath(dir));
  const double share = baselines.front().Share();
  const std::string words = "It fails without any obstacle in " + CountsOf(baselines);
  if (share >= 0.5) return words + ": what follows says little about obstacles.";
  if (share >= 0.1) return words + ": a failure may have nothing to do with obstacles.";
  return words + ".";
}

Question BaselineQuestion() {
  return {.name = "baseline",
          .summary = "how often does the swarm fail without any obstacle?",
          .help = kBaselineHelp,
          .named = Question::Named::kNone,
          .cases = EmptyArenas,
          .about = AboutBaseline,
          .tell = TellBaseline};
}

}  // namespace gauntlet
