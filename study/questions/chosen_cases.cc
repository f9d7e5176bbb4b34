#include "study/questions/chosen_cases.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/number_text.h"
#include "base/parse_number.h"
#include "search/cases/corpus_file.h"
#include "search/search_table.h"
#include "study/sets/case_set.h"

namespace gauntlet {
namespace {

constexpr int kMostCases = 1'000'000;
constexpr std::string_view kRandom = "random:";
constexpr std::string_view kCorpus = "corpus:";

Error OtherScenario(const std::string& place, const std::string& there, const Experiment& experiment) {
  return InvalidInput(fmt::format("{}: its cases are of the scenario '{}', the experiment {} has '{}'", place,
                                  there, experiment.name, experiment.scenario));
}

Result<ChosenCases> ChooseRandom(const std::string& number, const Experiment& experiment) {
  const auto count = ParseNumber<int>(number);
  if (!count || *count < 1 || *count > kMostCases)
    return InvalidInput(
        fmt::format("random:{}: a whole number from 1 to {} is needed", number, FormatCount(kMostCases)));
  ChosenCases chosen{
      fmt::format("{} random case{} of seed {}", FormatCount(static_cast<std::uint64_t>(*count)),
                  *count == 1 ? "" : "s", experiment.seed),
      {{}},
      {}};
  TRY(chosen.groups.front().cases, DrawRandomCases(experiment, *count));
  return chosen;
}

Result<ChosenCases> ChooseCorpus(const std::string& directory, const Experiment& experiment) {
  TRY(const std::vector<CorpusEntry> entries, ReadCorpus(directory));
  ChosenCases chosen{fmt::format("the {} of corpus {}", Counted(entries.size(), "case"), directory),
                     {{directory, false, {}}},
                     {}};
  for (const CorpusEntry& entry : entries) {
    if (const std::string scenario = SettingOf(entry.content, "scenario"); scenario != experiment.scenario)
      return OtherScenario(entry.file, scenario, experiment);
    sim::TestCase& one = chosen.groups.front().cases.emplace_back(entry.content.document.test_case);
    one.name = entry.content.name;
  }
  return chosen;
}

Result<ChosenCases> ChooseOfCampaigns(const std::string& text, const Experiment& experiment) {
  TRY(const std::vector<CaseSet> sets, ReadCaseSets(text));
  ChosenCases chosen;
  std::size_t count = 0;
  for (const CaseSet& set : sets) {
    if (set.experiment.scenario != experiment.scenario)
      return OtherScenario(set.place, set.experiment.scenario, experiment);
    ChosenCases::Group& group =
        chosen.groups.emplace_back(ChosenCases::Group{set.place, RowOf(set.experiment).Related(), {}});
    for (const Individual& member : set.members) {
      group.cases.push_back(member.test_case);
      group.cases.back().name = fmt::format("{} individual {}", set.place, member.id);
    }
    count += group.cases.size();
    chosen.notes.insert(chosen.notes.end(), set.notes.begin(), set.notes.end());
  }
  chosen.words = fmt::format("the {} of {}", Counted(count, "case"), text);
  if (sets.size() > 1) chosen.words += fmt::format(" ({} searches)", sets.size());
  return chosen;
}

}  // namespace

Result<ChosenCases> ChooseCases(const std::string& on, const Experiment& experiment) {
  Result<ChosenCases> chosen = on.starts_with(kRandom)   ? ChooseRandom(on.substr(kRandom.size()), experiment)
                               : on.starts_with(kCorpus) ? ChooseCorpus(on.substr(kCorpus.size()), experiment)
                                                         : ChooseOfCampaigns(on, experiment);
  if (!chosen) return Error{chosen.error().kind, "--on " + chosen.error().message};
  return chosen;
}

Result<std::vector<sim::TestCase>> DrawRandomCases(const Experiment& experiment, int count) {
  Experiment random = experiment;
  random.search = {.algorithm = "random", .parameters = {{"cases", static_cast<double>(count)}}};
  TRY(const std::unique_ptr<SearchAlgorithm> search, MakeSearch(random));
  std::vector<sim::TestCase> cases;
  while (!search->Progress().finished) {
    for (EvaluationRequest& request : search->Ask()) {
      request.test_case.name = fmt::format("random {}", request.individual);
      cases.push_back(std::move(request.test_case));
      search->Tell(OutcomeOfRuns(request.individual, request.evaluation, {}));
    }
  }
  return cases;
}

}  // namespace gauntlet
