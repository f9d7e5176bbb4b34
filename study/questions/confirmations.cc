#include "study/questions/confirmations.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/shell_quoted.h"
#include "controllers/registry.h"
#include "master/directory/plugins.h"
#include "proto/json_text.h"
#include "proto/run_failure.h"
#include "proto/run_text.h"
#include "search/experiment/experiment_file.h"
#include "search/experiment/failure_cells.h"
#include "search/experiment/schema.h"
#include "search/given/repeated_case.h"
#include "search/search_table.h"
#include "study/questions/baselines.h"

namespace gauntlet {
namespace {

Result<QuestionedCampaign> CasesToConfirm(const Asking& asking) {
  const bool elites = asking.Has("--elites");
  const bool all_failing = asking.Has("--all-failing");
  if (int{!asking.cases.empty()} + int{all_failing} + int{elites} != 1)
    return InvalidInput("which cases? Either RUN_ID or FILE..., or --all-failing, or --elites");
  if (!elites && !all_failing) return NamedCases(asking.place, asking.cases);
  TRY(auto questioned, elites ? PopulationCases(asking.place) : FailingCases(asking.place));
  if (!questioned.cases.empty()) return questioned;
  return InvalidInput(
      fmt::format("{}: {}, so there is no case to confirm", asking.place,
                  elites ? "its search has found nothing that is worth keeping" : "no run has failed"));
}

Result<int> ReplicatesOf(const Asking& asking) {
  return WholeNumber(asking, "--replicates", 1, 100000, /*otherwise=*/0);
}

constexpr const char* kEngineOption = "--engine";

const Key& EngineKey() {
  return *std::ranges::find(BuiltInKeys(), std::string("physics"), &Key::path);
}

bool IsExperimentFile(const std::string& engine) {
  return engine.ends_with(".toml");
}

// Where the cases are simulated, in a word; of an experiment's file its name.
std::string EngineOf(const Asking& asking) {
  const std::string engine = asking.Value(kEngineOption);
  return IsExperimentFile(engine) ? std::filesystem::path(engine).stem().string() : engine;
}

Result<Experiment> ReadElsewhere(const std::string& file, const Experiment& experiment) {
  TRY(const ExperimentText text, ReadExperimentText(file));
  TRY(const Catalogue catalogue, CatalogueFor(text, {}, {}, {}));
  TRY(Experiment elsewhere, ParseExperiment(text.text, text.file_name, {}, catalogue));
  elsewhere.seed = experiment.seed;
  return elsewhere;
}

Result<Experiment> AboutConfirmation(const Experiment& experiment, const Asking& asking) {
  TRY(const int replicates, ReplicatesOf(asking));
  const std::string engine = asking.Value(kEngineOption);
  if (IsExperimentFile(engine)) {
    TRY(const Experiment elsewhere, ReadElsewhere(engine, experiment));
    return ConfirmationOf(elsewhere, replicates);
  }
  Experiment confirmation = ConfirmationOf(experiment, replicates);
  if (engine.empty()) return confirmation;
  if (StartsProgram(experiment))
    return InvalidInput(
        fmt::format("--engine {}: '{}' is simulated by a program of yours", engine, experiment.name));
  const Key& key = EngineKey();
  if (engine == "argos")
    return InvalidInput(
        "--engine argos: ARGoS simulates adopted projects; name the experiment that 'gauntlet adopt' wrote, "
        "--engine NAME.toml");
  if (std::ranges::find(key.choices, engine) == key.choices.end())
    return InvalidInput(
        fmt::format("--engine {}: the engines are {}, and experiments by their files, NAME.toml", engine,
                    fmt::join(key.choices, ", ")));
  if (key.get(experiment) == KeyValue(engine))
    return InvalidInput(
        fmt::format("--engine {}: the search itself ran under it; leave the option out", engine));
  key.set(confirmation, engine);
  return confirmation;
}

// What is known of these cases elsewhere, by their names.
Status AddElsewhere(const std::string& dir, std::vector<Confirmation>& confirmations) {
  std::vector<std::string> engines;
  const std::string prefix = fmt::format("{}-", ConfirmQuestion().name);
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(dir, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix)) engines.push_back(name.substr(prefix.size()));
  }
  for (const std::string& engine : engines) {
    TRY(auto answers, AnswersOfCalls(FolderOf(ConfirmQuestion(), dir, engine), ConfirmationKey));
    for (const CaseAnswer& one : BestOf(std::move(answers))) {
      const auto same = std::ranges::find(confirmations, one.name, &Confirmation::name);
      if (same != confirmations.end()) same->elsewhere[engine] = one.tally();
    }
  }
  return Ok{};
}

// A run without a result would end without one again.
bool HasEnoughRuns(const CaseAnswer& answer, const Asking& asking) {
  const int replicates = ReplicatesOf(asking).value();
  return replicates == 0 || RunsToVerdict(answer.tally(), replicates) == 0;
}

Result<Told> TellConfirmations(const Asking& asking, const Call& /*call*/,
                               std::span<const CaseAnswer> answers) {
  std::vector<Confirmation> cases;
  for (const CaseAnswer& one : answers) cases.push_back(ConfirmationIn(one));
  const Table table = ConfirmationsTable(cases);
  const auto confirmed = std::ranges::count(cases, FailureVerdict::kFail, &Confirmation::verdict);
  const auto files = std::ranges::count(cases, RunId{0}, &Confirmation::run);
  const std::string engine = EngineOf(asking);
  const std::string of_files =
      files == 0 ? "" : fmt::format(" ({} from {})", files, files == 1 ? "a file" : "files");
  if (!engine.empty()) {
    return Told{
        .section = {.table = table,
                    .sentences = {fmt::format(
                        "{} of {} cases{} hold under {}: with fresh seeds they fail in at least half of the "
                        "runs there, too.",
                        confirmed, cases.size(), of_files, engine)}},
        .json = JsonText({{"engine", engine}, {"cases", table.ToJson()}})};
  }
  TRY(const std::vector<Baseline> baselines, ReadBaselines(asking.place));
  Told told{.section = {.table = table},
            .json = JsonText({{"cases", table.ToJson()}, {"baseline", BaselinesTable(baselines).ToJson()}})};
  const std::string baseline = InWords(baselines, asking.program, asking.place);
  if (Matters(baselines)) told.section.lead = {baseline};
  told.section.sentences = {
      fmt::format("{} of {} cases{} confirmed: with fresh seeds they fail in at least half of the runs.",
                  confirmed, cases.size(), of_files)};
  if (!Matters(baselines)) told.section.sentences.push_back(baseline);
  const Confirmation* toughest = ToughestOf(cases);
  if (toughest == nullptr) return told;
  const std::string dir = PastedPath(asking.place);
  told.section.commands = {
      {fmt::format("{} minimise {} {}", asking.program, dir, proto::RunText(toughest->run)),
       "which of its obstacles does it take?"},
      {fmt::format("{} blame {} {}", asking.program, dir, proto::RunText(toughest->run)),
       "how much does each of them do?"}};
  return told;
}

constexpr const char* kConfirmHelp =
    R"(A search keeps what failed once, and some of that was luck. Here every case is simulated with seeds that
took no part in choosing it, until it has failed 5 times or not failed 6 times (at most 10 runs). What counts
as failing is the scenario's: a total failure; of foraging, that no item reached the nest.

Verdicts: fail (confirmed: in at least half of the runs), flaky (less often), pass (never), error (a run ended
without a result). All is kept in DIR/confirm, is shown by 'show', and leaves the campaign as it was; a case
that is known already is not simulated again. After Ctrl-C the same command goes on.

With --engine box2d the cases are simulated under Box2D's contacts instead of those that the search had. A failure
that does not hold there may be one of the model of contacts rather than of the controller. With --engine NAME.toml they
are simulated by another experiment, such as one that 'gauntlet adopt' made of the same controller's ARGoS project. What
comes of it is kept in DIR/confirm-box2d, or DIR/confirm-NAME, and stands beside the confirmed cases in 'show --json'.

Examples:
  gauntlet confirm DIR 812
  gauntlet confirm DIR --all-failing --json
  gauntlet confirm DIR --elites
  gauntlet confirm DIR 812 817 --replicates 100
  gauntlet confirm DIR --elites --engine box2d --replicates 30
  gauntlet confirm DIR --elites --engine adopted.toml
  gauntlet confirm DIR my-case.json)";

}  // namespace

std::uint64_t ConfirmationKey(const Experiment& experiment, const sim::TestCase& test_case) {
  return KeyOfCase(ConfirmationOf(experiment, 0), test_case);
}

Confirmation ConfirmationIn(const CaseAnswer& answer) {
  const Experiment& experiment = *answer.experiment;
  Confirmation one{.name = answer.name,
                   .run = answer.run,
                   .key = answer.key,
                   .tally = answer.tally(),
                   .verdict = FailureVerdict::kOpen,
                   .interval = {},
                   .middle = {},
                   .message = answer.Message(),
                   .campaign = answer.campaign};
  one.verdict = VerdictOf(one.tally, ConfirmationReplicates(experiment));
  one.interval = FailureInterval(one.tally);
  if (one.tally.failures == 0) return one;
  const controllers::ScenarioInfo& scenario = controllers::DeclaredScenario(experiment);
  const FailurePlaces places(scenario, experiment.scenario_parameters, answer.test_case);
  const DescriptorGrid grid(CellsOf(experiment));
  std::vector<Descriptor> described;  // those of the failed runs that could be
  for (const CaseRun& run : answer.runs) {
    if (run.became.tally.failures == 0) continue;
    one.failed.push_back({run.id, {run.whereabouts.mechanism, places.Of(run.result.metrics)}});
    if (auto failure = grid.Describe({.metrics = run.result.metrics}))
      described.push_back(*std::move(failure));
  }
  if (!described.empty()) one.middle = MiddleOf(described);
  return one;
}

const FailedRun* Confirmation::Typical() const {
  if (failed.empty()) return nullptr;
  std::vector<std::string> mechanisms, places;
  for (const FailedRun& one : failed) {
    mechanisms.push_back(one.features.mechanism);
    places.push_back(one.features.place);
  }
  const auto mechanism = LeadingOf(mechanisms);
  const auto place = LeadingOf(places);
  const auto agrees = [&](const FailedRun& one) {
    return int{mechanism && one.features.mechanism == mechanism->value} +
           int{place && one.features.place == place->value};
  };
  return &*std::ranges::max_element(failed, {}, agrees);
}

double Toughness(const Confirmation& one) {
  return one.interval.low;
}

Result<std::vector<Confirmation>> ReadConfirmations(const std::string& dir) {
  TRY(auto answers, AnswersOfCalls(FolderOf(ConfirmQuestion(), dir), ConfirmationKey));
  std::vector<Confirmation> confirmations;
  for (const CaseAnswer& one : BestOf(std::move(answers))) confirmations.push_back(ConfirmationIn(one));
  TRY(AddElsewhere(dir, confirmations));
  std::ranges::sort(confirmations, [](const Confirmation& a, const Confirmation& b) {
    return std::pair(a.run, a.name) < std::pair(b.run, b.name);
  });
  return confirmations;
}

const Confirmation* ToughestOf(const std::vector<Confirmation>& confirmations) {
  const Confirmation* toughest = nullptr;
  for (const Confirmation& one : confirmations) {
    if (one.verdict != FailureVerdict::kFail || one.run == 0) continue;
    if (toughest == nullptr || Toughness(one) > Toughness(*toughest)) toughest = &one;
  }
  return toughest;
}

Result<CampaignAnswers> ReadAnswers(const std::string& dir) {
  CampaignAnswers answers;
  TRY(answers.confirmations, ReadConfirmations(dir));
  TRY(answers.smallest_layouts, ReadSmallestLayouts(dir));
  TRY(answers.baselines, ReadBaselines(dir));
  return answers;
}

Table ConfirmationsTable(const std::vector<Confirmation>& confirmations) {
  std::set<std::string> engines;
  for (const Confirmation& one : confirmations) {
    for (const auto& [engine, tally] : one.elsewhere) engines.insert(engine);
  }
  std::vector<Column> columns = {ForPrograms("run"),
                                 {"case", "case"},
                                 {">failed", "k n"},
                                 {"probability (95 %)", "interval"},
                                 {"verdict", "verdict"}};
  for (const std::string& engine : engines)
    columns.emplace_back(">in " + engine, fmt::format("{0}_k {0}_n", engine));
  columns.emplace_back("", "message?");
  Table table(columns);
  for (const Confirmation& one : confirmations) {
    std::vector<Cell> row = {one.run > 0 ? Cell(one.run) : Cell(), one.name,
                             OutOfCell(one.tally.failures, one.tally.runs()), PercentCell(one.interval),
                             NameOf(one.verdict)};
    for (const std::string& engine : engines) {
      const auto known = one.elsewhere.find(engine);
      row.push_back(known == one.elsewhere.end() ? JsonCell(nlohmann::ordered_json::array({nullptr, nullptr}))
                                                 : OutOfCell(known->second.failures, known->second.runs()));
    }
    row.emplace_back(proto::Explained(one.message), TextValue(one.message));
    table.AddRow(std::move(row));
  }
  return table;
}

Question ConfirmQuestion() {
  using Kind = QuestionOption::Kind;
  return {
      .name = "confirm",
      .summary = "do cases fail again with fresh seeds, and how often?",
      .help = kConfirmHelp,
      .named = Question::Named::kAny,
      .options =
          {{"--all-failing", "", "every case of the campaign that has failed once", Kind::kFlag},
           {"--elites", "",
            "the cases that the search has ended with: its population, or the elites of an archive",
            Kind::kFlag},
           {"--replicates", "N", "exactly N runs per case, for a narrower interval"},
           {kEngineOption, "E",
            "under this physics engine instead of the search's, box2d or impulse, or by another experiment, "
            "NAME.toml"}},
      .cases = CasesToConfirm,
      .about = AboutConfirmation,
      .variant = EngineOf,
      .key = ConfirmationKey,
      .enough = HasEnoughRuns,
      .tell = TellConfirmations,
      .looks_at_empty_arena = true};
}

}  // namespace gauntlet
