#include "search/archive/cma_me_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "controllers/registry.h"
#include "search/archive/archive_search.h"
#include "search/experiment/failure_cells.h"
#include "search/experiment/genome_ranges.h"

namespace gauntlet {
namespace {

const std::vector<controllers::ParameterInfo> kCmaMeParameters = {
    {"emitters", "", 5, 1, 50, true, "cma-me only: number of CMA-ES that propose cases (chosen)",
     /*came_later=*/true}};

// Chosen: of ranges that are 1 long. The paper has 0.5 where there are no bounds.
constexpr double kEmitterStep = 0.2;

constexpr std::size_t kNumbersOfAGene = 5;

// `place`: 0 to 1; `step`: of the grid, 0 = none.
double ValueAt(double place, double min, double max, double step) {
  if (step == 0.0) return min + place * (max - min);
  const GridRange grid = GridOf(min, max, step);
  const auto points = static_cast<double>(grid.last - grid.first + 1);
  return (static_cast<double>(grid.first) + std::min(std::floor(place * points), points - 1.0)) /
         grid.divisions;
}

}  // namespace

CmaMeSearch::CmaMeSearch(const SearchSetup& setup)
    : PopulationSearch(setup), failing_(FailingOf(setup.experiment)), grid_(CellsOf(setup.experiment)) {
  const auto emitters = static_cast<std::size_t>(ValueOf(kCmaMeParameters[0], spec().parameters));
  while (emitters_.size() < emitters) {
    emitters_.push_back(Begin());
    Propose(emitters_.size() - 1);
  }
}

Result<std::unique_ptr<CmaMeSearch>> CmaMeSearch::Create(const SearchSetup& setup) {
  TRY(CheckCollecting(setup.experiment));
  sim::RandomStream random = GenomeStream(SearchSeed(setup), 1);
  TRY(MakeGenerator(setup).RandomTestCase(random));
  return std::unique_ptr<CmaMeSearch>(new CmaMeSearch(setup));
}

std::vector<EvaluationRequest> CmaMeSearch::Ask() {
  std::vector<EvaluationRequest> requests;
  for (; asked_ < waiting_.size() && evaluations_done_ + asked_ < PlannedEvaluations(setup_.experiment);
       ++asked_) {
    newborns_.push_back(waiting_[asked_].finding.individual);
    requests.push_back(Request(newborns_.back(), 1));
  }
  return requests;
}

CmaMeSearch::Emitter CmaMeSearch::Begin() const {
  sim::RandomStream random(search_seed_, sim::StreamPurpose::kVariation,
                           static_cast<std::uint32_t>(next_id_));
  const std::uint64_t seed = random.NextUint64();
  if (elites_.empty()) {
    const std::size_t numbers = kNumbersOfAGene * static_cast<std::size_t>(generator_.spec().genes);
    return {CmaEs(SettingsPoint(numbers, 0.5), kEmitterStep, seed)};
  }
  const std::uint32_t drawn = random.Below(static_cast<std::uint32_t>(elites_.size()));
  const Proposal& elite = std::next(elites_.begin(), drawn)->second;
  return {CmaEs(elite.point, kEmitterStep, seed), elite.finding.individual.id};
}

void CmaMeSearch::Propose(std::size_t emitter) {
  emitters_[emitter].ranks.clear();
  const IndividualId parent = emitters_[emitter].parent;
  for (SettingsPoint& point : emitters_[emitter].cma.Ask()) {
    Proposal& proposal = waiting_.emplace_back();
    Individual& individual = proposal.finding.individual;
    individual = MakeIndividual(next_id_, CaseAt(point, next_id_));
    if (parent != 0) individual.parents = {parent};
    proposal.point = std::move(point);
    proposal.emitter = emitter;
    ++next_id_;
  }
}

sim::TestCase CmaMeSearch::CaseAt(const SettingsPoint& point, IndividualId id) const {
  const GenomeSpec& ranges = generator_.spec();
  const auto [min, max] = ranges.Places();
  sim::RandomStream random = GenomeStream(search_seed_, id);
  while (true) {  // Create has found that there are valid cases
    std::vector<GeneDraw> draws;
    for (std::size_t i = 0; i < point.size(); i += kNumbersOfAGene) {
      sim::ObstacleGene& gene = draws.emplace_back(generator_.DrawGene(random)).first;
      gene.x = ValueAt(point[i], min.x(), max.x(), ranges.step);
      gene.y = ValueAt(point[i + 1], min.y(), max.y(), ranges.step);
      gene.length = ValueAt(point[i + 2], ranges.length_min, ranges.length_max, ranges.step);
      gene.width = ValueAt(point[i + 3], ranges.width_min, ranges.width_max, ranges.step);
      gene.orientation_deg = ValueAt(point[i + 4], 0.0, 359.0, 1.0);
    }
    if (Result<sim::TestCase> placed = generator_.CaseOf(draws); placed.ok()) return *std::move(placed);
  }
}

bool CmaMeSearch::HasCell(const RunOutcome& run, const Descriptor& descriptor) const {
  if (Fails(run, failing_)) return true;  // as in the archive search
  const controllers::ScenarioInfo& scenario = *controllers::FindScenario(setup_.experiment);
  for (std::size_t i = 0; i < descriptor.size(); ++i) {
    const auto* metric = controllers::FindMetric(scenario, grid_.axes()[i].metric);
    if (metric != nullptr && metric->none == descriptor[i]) return false;
  }
  return true;
}

std::pair<EmitterRank::Entry, double> CmaMeSearch::Enter(Proposal proposal) {
  const double fitness = proposal.finding.individual.fitness;
  if (proposal.finding.failures.empty() || !std::isfinite(fitness))
    return {EmitterRank::Entry::kNone, fitness};
  const std::size_t cell = grid_.CellOf(proposal.finding.Middle());
  const auto [elite, is_new] = elites_.try_emplace(cell, proposal);
  if (is_new) return {EmitterRank::Entry::kNewCell, fitness};
  const double before = elite->second.finding.individual.fitness;
  if (fitness >= before) return {EmitterRank::Entry::kNone, fitness};
  elite->second = std::move(proposal);
  return {EmitterRank::Entry::kImprovedCell, fitness - before};
}

void CmaMeSearch::Told(const EvaluationOutcome& outcome) {
  Proposal proposal = std::move(waiting_.front());
  waiting_.pop_front();
  if (asked_ > 0) --asked_;  // those that Restore tells were not asked for
  Finding& finding = proposal.finding;
  Record(outcome, finding.individual);
  for (const RunOutcome& run : outcome.runs) {
    finding.tally.Add(run, failing_);
    const std::optional<Descriptor> descriptor = grid_.Describe(run);
    if (descriptor && HasCell(run, *descriptor)) finding.failures.push_back(*descriptor);
  }
  const std::size_t number = proposal.emitter;
  Emitter& emitter = emitters_[number];
  const auto [entry, value] = Enter(std::move(proposal));
  emitter.ranks.push_back({entry, value, emitter.ranks.size()});
  if (entry != EmitterRank::Entry::kNone) {
    population_.clear();
    for (const auto& [cell, elite] : elites_) {
      if (elite.fails()) population_.push_back(elite.finding.individual);
    }
  }
  if (emitter.ranks.size() < emitter.cma.population()) return;
  std::ranges::sort(emitter.ranks);
  if (emitter.ranks.front().entry == EmitterRank::Entry::kNone) {
    emitter = Begin();
    ++restarts_;
  } else {
    std::vector<std::size_t> best_first;
    for (const EmitterRank& rank : emitter.ranks) best_first.push_back(rank.place);
    emitter.cma.Tell(best_first);
  }
  Propose(number);
}

ArchiveView CmaMeSearch::Archive() const {
  ArchiveView view{.axes = grid_.axes(), .failures = {}, .toughest = true};
  for (const auto& [cell, elite] : elites_) {
    const Finding& found = elite.finding;
    if (!elite.fails()) continue;
    view.failures.push_back(
        {grid_.PartsOf(cell), found.Middle(), found.individual.id, found.tally.failures, found.tally.runs()});
  }
  return view;
}

SearchProgress CmaMeSearch::Progress() const {
  return {.generation = 1,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = PlannedEvaluations(setup_.experiment),
          .individuals_planned = PlannedEvaluations(setup_.experiment),
          .finished = evaluations_done_ >= PlannedEvaluations(setup_.experiment)};
}

std::vector<std::pair<std::string, double>> CmaMeSearch::Statistics() const {
  return {{"cells_filled", static_cast<double>(population_.size())},
          {"cells_without_failure", static_cast<double>(elites_.size() - population_.size())},
          {"restarts", static_cast<double>(restarts_)}};
}

bool CmaMeSearch::AtBoundary() const {
  return evaluations_done_ % kSaveInterval == 0 || evaluations_done_ == PlannedEvaluations(setup_.experiment);
}

Status CmaMeSearch::RestoreRest(CanonicalDecoder& /*decoder*/, const History& history) {
  return Recall(history, [this](const EvaluationOutcome& outcome) { Told(outcome); });
}

SearchRow CmaMeRow() {
  return {
      .info = {.name = "cma-me",
               .description = "CMA-ME with improvement emitters (Fontaine and others 2020), a baseline",
               .keys = {"search.replicates", "search.cells", "search.objective", "search.runs", "genome."},
               .parameters = kCmaMeParameters,
               .length = "search.runs",
               .check =
                   [](const Experiment& experiment) {
                     const std::optional<BrokenRule> broken = CheckCells(experiment);
                     return broken ? broken : CheckObjective(experiment);
                   }},
      .number = 14,
      .title = "CMA-ME search",
      .individuals = Individuals::kElites,
      .plan = PlanOfRuns,
      .make = Make<CmaMeSearch>};
}

}  // namespace gauntlet
