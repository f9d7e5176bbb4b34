#include "study/repairs/repair_cases.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/number_text.h"
#include "master/campaign/stored_campaign.h"
#include "search/cases/corpus_file.h"
#include "search/search_table.h"
#include "sim/random/random_stream.h"
#include "study/questions/chosen_cases.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {
namespace {

constexpr std::size_t kFewestUnits = 10;  // below, an interval over units says little
constexpr std::size_t kFewestCases = 10;

// The individual that the first parents of each lead back to, by the hash of its case.
Result<std::map<std::uint64_t, IndividualId>> LineagesOf(const SearchPlan& plan, ResultStore& store) {
  TRY(const std::vector<Individual> individuals, store.LoadIndividuals(plan.id));
  std::map<IndividualId, IndividualId> founder;
  std::map<std::uint64_t, IndividualId> lineages;
  for (const Individual& one : individuals) {  // parents before their children
    const auto parent = one.parents.empty() ? founder.end() : founder.find(one.parents.front());
    founder[one.id] = parent == founder.end() ? one.id : parent->second;
    lineages.emplace(CaseHash(one.test_case), founder[one.id]);
  }
  return lineages;
}

Status CheckScenario(const std::string& scenario, const std::string& place, const Experiment& experiment) {
  if (scenario == experiment.scenario) return Ok{};
  return InvalidInput(fmt::format("{}: its cases are of the scenario '{}', and the controller is for '{}'",
                                  place, scenario, experiment.scenario));
}

// Whole units in an order that the seed decides, at most `most` cases: of each unit the next in turn.
std::vector<CaseUnit> Spread(std::vector<CaseUnit> units, std::size_t most, std::uint64_t seed) {
  sim::RandomStream random(seed, sim::StreamPurpose::kVariation);
  for (std::size_t i = units.size(); i > 1; --i)
    std::swap(units[i - 1], units[random.Below(static_cast<std::uint32_t>(i))]);
  std::vector<CaseUnit> spread(units.size());
  std::size_t taken = 0;
  bool more = true;
  for (std::size_t turn = 0; more && taken < most; ++turn) {
    more = false;
    for (std::size_t i = 0; i < units.size() && taken < most; ++i) {
      if (turn >= units[i].size()) continue;
      // Cases of a unit are born one after the other, the tougher later.
      spread[i].push_back(std::move(units[i][units[i].size() - 1 - turn]));
      ++taken;
      more = true;
    }
  }
  std::erase_if(spread, [](const CaseUnit& one) { return one.empty(); });
  return spread;
}

std::size_t CasesIn(const std::vector<CaseUnit>& units) {
  std::size_t cases = 0;
  for (const CaseUnit& one : units) cases += one.size();
  return cases;
}

// Two halves of whole units; of all cases as a single unit where too few would judge otherwise.
std::pair<std::vector<CaseUnit>, std::vector<CaseUnit>> Halves(std::vector<CaseUnit> units) {
  std::vector<CaseUnit> halves[2];
  std::ranges::stable_sort(units, std::greater(), &CaseUnit::size);
  for (CaseUnit& one : units)
    halves[CasesIn(halves[0]) <= CasesIn(halves[1]) ? 0 : 1].push_back(std::move(one));
  if (CasesIn(halves[1]) >= kFewestCases) return {std::move(halves[0]), std::move(halves[1])};
  CaseUnit all;
  for (std::vector<CaseUnit>& half : halves) {
    for (CaseUnit& one : half) std::ranges::move(one, std::back_inserter(all));
  }
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>((all.size() + 1) / 2);
  std::vector<CaseUnit> judging;
  if (middle != all.end()) judging.emplace_back(middle, all.end());
  return {{CaseUnit(all.begin(), middle)}, std::move(judging)};
}

}  // namespace

Result<std::vector<CaseUnit>> UnitsOfCorpus(const std::string& directory, const Experiment& experiment) {
  TRY(const std::vector<CorpusEntry> entries, ReadCorpus(directory));
  std::vector<CaseUnit> units;
  for (const CorpusEntry& one : entries) {
    TRY(CheckScenario(SettingOf(one.content, "scenario"), one.file, experiment));
    if (one.content.expected != "fail") continue;
    sim::TestCase test_case = one.content.document.test_case;
    test_case.name = one.content.name;
    units.push_back({std::move(test_case)});
  }
  return units;
}

Result<std::vector<CaseUnit>> UnitsOfCampaigns(const std::vector<std::string>& directories,
                                               const Experiment& experiment) {
  std::vector<CaseUnit> by_search;
  std::map<IndividualId, CaseUnit> by_lineage;
  std::set<std::uint64_t> known;
  for (const std::string& dir : directories) {
    TRY(const StoredCampaign campaign, OpenStoredCampaign(dir));
    TRY(CheckScenario(campaign.plans.front().experiment.scenario, dir, experiment));
    if (RowOf(campaign.plans.front().experiment).varies_settings)
      return InvalidInput(
          fmt::format("{}: its runs are of many settings ({}); name the campaigns that its "
                      "cases come from",
                      dir, RowOf(campaign.plans.front().experiment).title));
    TRY(QuestionedCampaign failing, FailingCases(dir));
    std::vector<CaseUnit> searches(failing.plans.size());
    const bool lineages = directories.size() == 1 && campaign.plans.size() == 1;
    std::map<std::uint64_t, IndividualId> lineage;
    if (lineages) {
      TRY(lineage, LineagesOf(campaign.plans.front(), *campaign.view.store));
    }
    for (CaseInQuestion& one : failing.cases) {
      const std::uint64_t hash = CaseHash(one.test_case);
      if (!known.insert(hash).second) continue;
      one.test_case.name = directories.size() == 1 ? one.name : fmt::format("{} of {}", one.name, dir);
      if (!RowOf(campaign.plans[one.search].experiment).Related()) {
        by_search.push_back({std::move(one.test_case)});
      } else {
        (lineages ? by_lineage[lineage[hash]] : searches[one.search]).push_back(std::move(one.test_case));
      }
    }
    for (CaseUnit& one : searches) {
      if (!one.empty()) by_search.push_back(std::move(one));
    }
  }
  for (auto& [founder, unit] : by_lineage) by_search.push_back(std::move(unit));
  return by_search;
}

namespace {

// The cases of `units` out of `judging`; how many these were.
std::size_t TakeOut(const std::vector<CaseUnit>& units, std::vector<CaseUnit>& judging) {
  std::set<std::uint64_t> training;
  for (const CaseUnit& unit : units) {
    for (const sim::TestCase& one : unit) training.insert(CaseHash(one));
  }
  std::size_t taken = 0;
  for (CaseUnit& unit : judging)
    taken += std::erase_if(unit, [&](const sim::TestCase& one) { return training.contains(CaseHash(one)); });
  std::erase_if(judging, [](const CaseUnit& one) { return one.empty(); });
  return taken;
}

}  // namespace

Result<ChosenRepairCases> ChooseRepairCases(const RepairCaseChoice& choice, Experiment& experiment) {
  std::vector<CaseUnit> units;
  if (choice.corpus.empty()) {
    TRY(units, UnitsOfCampaigns(choice.from, experiment));
  } else {
    TRY(units, UnitsOfCorpus(choice.corpus, experiment));
  }
  ChosenRepairCases chosen;
  std::vector<CaseUnit> judging;
  if (!choice.held_out.empty()) {
    TRY(judging, UnitsOfCampaigns(choice.held_out, experiment));
  }
  std::size_t refused = 0;
  for (std::vector<CaseUnit>* both : {&units, &judging}) {
    for (CaseUnit& unit : *both)
      refused += std::erase_if(
          unit, [&](const sim::TestCase& one) { return RefusalOf(experiment, one).has_value(); });
    std::erase_if(*both, [](const CaseUnit& one) { return one.empty(); });
  }
  if (refused > 0) chosen.notes.push_back(Counted(refused, "case") + " left out, as a rule is broken");
  if (units.empty())
    return InvalidInput(
        (choice.corpus.empty() ? fmt::format("{}", fmt::join(choice.from, ",")) : choice.corpus) +
        " holds no case that fails: there is nothing to repair");
  if (const std::size_t twice = TakeOut(units, judging); twice > 0)
    chosen.notes.push_back(Counted(twice, "held-out case") + " left out, as they train");
  if (!choice.held_out.empty() && judging.empty())
    return InvalidInput(fmt::format("--held-out {}: no failing case that does not train is left to judge",
                                    fmt::join(choice.held_out, ",")));
  if (choice.held_out.empty()) {
    std::tie(units, judging) = Halves(Spread(std::move(units), kMostFailing, experiment.seed));
  } else {
    units = Spread(std::move(units), kMostFailing / 2, experiment.seed);
    judging = Spread(std::move(judging), kMostFailing / 2, experiment.seed);
  }
  if (CasesIn(judging) < kFewestCases) {
    chosen.notes.push_back(fmt::format("{} held out: fewer than {} judge nothing",
                                       Counted(CasesIn(judging), "failing case"), kFewestCases));
  } else if (judging.size() < kFewestUnits) {
    chosen.notes.push_back(fmt::format(
        "the {} that judge come from {} (searches, or lineages of one): what holds of them may not hold "
        "of others",
        Counted(CasesIn(judging), "held-out case"), Counted(judging.size(), "independent unit")));
  }
  for (CaseUnit& unit : units) std::ranges::move(unit, std::back_inserter(chosen.cases));
  RepairSpec& spec = experiment.repair;
  spec.training = spec.guards = static_cast<int>(chosen.cases.size());
  const auto guards = static_cast<int>(chosen.cases.size());
  Experiment fresh = experiment;  // its own seed's random cases may be those that train
  fresh.seed = sim::DeriveSeed(experiment.seed, sim::SeedPurpose::kRepair, 0, 0, 0, 0);
  TRY(std::vector<sim::TestCase> random, DrawRandomCases(fresh, guards + static_cast<int>(choice.random)));
  const auto middle = random.begin() + guards;
  std::move(random.begin(), middle, std::back_inserter(chosen.cases));
  spec.units.clear();
  for (CaseUnit& unit : judging) {
    spec.units += fmt::format("{}{}", spec.units.empty() ? "" : " ", unit.size());
    std::ranges::move(unit, std::back_inserter(chosen.cases));
  }
  std::move(middle, random.end(), std::back_inserter(chosen.cases));
  return chosen;
}

}  // namespace gauntlet
