#include "search/archive/archive_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "base/check.h"
#include "base/number_text.h"
#include "search/experiment/failure_cells.h"
#include "search/experiment/objective.h"
#include "sim/arena/genome.h"

namespace gauntlet {
namespace {

const std::vector<controllers::ParameterInfo> kArchiveParameters = {
    {"runs", "", 1000, 1, 1e8, true, "archive, random-deletion and cma-me only: number of simulations"},
    {"slots", "", 36, 1, 10000, true,
     "archive and random-deletion only: number of layouts under test at a time, and of workers kept busy"},
    {"keep_out", "m", 0, 0, 10, false,
     "archive and random-deletion only: no obstacle nearer than this to where the swarm starts and arrives"},
    {"alone_share", "", 0.60, 0, 1, false,
     "archive only: share of the lineages that begin with one to three obstacles across the path to the "
     "goal"},
    {"jittered_share", "", 0.10, 0, 1, false,
     "archive only: share of the lineages that begin with an elite that is changed a little"},
    {"recheck_share", "", 0.04, 0, 1, false,
     "archive only: share of the lineages that are one more run of an elite; the rest begin with random "
     "cases"},
};
enum Parameter : std::size_t { kRuns, kSlots, kKeepOut, kAcrossShare, kJitteredShare, kRecheckShare };

double Get(const Experiment& experiment, Parameter parameter) {
  return ValueOf(kArchiveParameters[parameter], experiment.search.parameters);
}

std::optional<BrokenRule> CheckBudget(const Experiment& experiment) {
  if (std::optional<BrokenRule> cells = CheckCells(experiment)) return cells;
  const int replicates = experiment.search.replicates;
  const int rounds = (ArchiveJudge::kFewestFailures + replicates - 1) / replicates;
  const double needed = ((rounds - 1) * Get(experiment, kSlots) + 1) * replicates;
  if (Get(experiment, kRuns) >= needed) return std::nullopt;
  return BrokenRule{
      "search.runs",
      fmt::format("search.runs = {} cannot fill a cell: a case has to fail in {} runs, and all "
                  "search.slots = {} cases have a run before one of them has its next; use {} runs or more, "
                  "or fewer slots",
                  Get(experiment, kRuns), ArchiveJudge::kFewestFailures, Get(experiment, kSlots), needed)};
}

std::optional<BrokenRule> CheckArchive(const Experiment& experiment) {
  const Objective objective = ObjectiveOf(experiment.search);
  if (objective != Objective::kFitness && objective != Objective::kRobustness) {
    return BrokenRule{
        "search.objective",
        fmt::format("search.objective = \"{}\": search.algorithm = \"archive\" looks for frequent and "
                    "small failures anyway; it can be steered by \"robustness\"",
                    kObjectiveNames.at(static_cast<std::size_t>(objective)))};
  }
  if (std::optional<BrokenRule> broken = CheckObjective(experiment)) return broken;
  return CheckBudget(experiment);
}

// Nothing: the number is no emitter's.
std::optional<Emitter> RestoreEmitter(CanonicalDecoder& decoder) {
  const std::uint64_t number = decoder.Uint();
  if (number >= kEmitters) return std::nullopt;
  return static_cast<Emitter>(number);
}

}  // namespace

std::string PlanOfRuns(const Experiment& experiment) {
  return FormatCount(static_cast<std::uint64_t>(Get(experiment, kRuns))) + " runs";
}

std::uint64_t PlannedEvaluations(const Experiment& experiment) {
  const auto replicates = static_cast<std::uint64_t>(experiment.search.replicates);
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(Get(experiment, kRuns)) / replicates);
}

Status CheckCollecting(const Experiment& experiment) {
  if (CellsOf(experiment).empty()) {
    return InvalidInput(
        fmt::format("scenario {} does not say along which metrics its failures differ, which "
                    "search.algorithm = \"{}\" needs: search.cells does",
                    experiment.scenario, experiment.search.algorithm));
  }
  if (experiment.genome.genes < 1) {
    return InvalidInput(
        fmt::format("genome.genes = {}: search.algorithm = \"{}\" looks for obstacles that break the swarm; "
                    "allow 1 or more",
                    experiment.genome.genes, experiment.search.algorithm));
  }
  return Ok{};
}

ArchiveSearch::ArchiveSearch(const SearchSetup& setup, const controllers::ScenarioInfo& scenario,
                             LinePolicy policy)
    : PopulationSearch(setup),
      only_deletion_(policy == LinePolicy::kDeletionOnly),
      steered_(!only_deletion_ && ObjectiveOf(setup.experiment.search) == Objective::kRobustness),
      failing_(scenario.failing),
      archive_(CellsOf(setup.experiment)),
      places_(!only_deletion_ && scenario.failures.ArePlaces(archive_.grid().axes())),
      proposer_(setup_, generator_, places_, archive_),
      judge_(archive_, prior_, !only_deletion_),
      slots_(static_cast<std::size_t>(Get(setup.experiment, kSlots))) {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    BeginAnew(slots_[i]);
    waiting_.push_back(i);
  }
}

Result<std::unique_ptr<ArchiveSearch>> ArchiveSearch::Create(const SearchSetup& setup, LinePolicy policy) {
  const Experiment& experiment = setup.experiment;
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(experiment);
  GAUNTLET_CHECK(scenario != nullptr, experiment.scenario);
  TRY(CheckCollecting(experiment));
  SearchSetup kept_out = setup;
  double& clearance = kept_out.requirements.clearance;
  clearance = std::max(clearance, Get(setup.experiment, kKeepOut));
  sim::RandomStream random = GenomeStream(SearchSeed(setup), 1);
  TRY(MakeGenerator(kept_out).RandomTestCase(random));
  return std::unique_ptr<ArchiveSearch>(new ArchiveSearch(kept_out, *scenario, policy));
}

std::vector<EvaluationRequest> ArchiveSearch::Ask() {
  std::vector<EvaluationRequest> requests;
  for (; asked_ < waiting_.size() && evaluations_done_ + asked_ < PlannedEvaluations(setup_.experiment);
       ++asked_) {
    const Slot& slot = slots_[waiting_[asked_]];
    const Individual& individual = slot.finding.individual;
    requests.push_back(Request(individual, 1));
    if (requests.back().evaluation == 0) newborns_.push_back(individual);
  }
  return requests;
}

SearchProgress ArchiveSearch::Progress() const {
  return {.generation = 1,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = PlannedEvaluations(setup_.experiment),
          .individuals_planned = next_id_ - 1,
          .finished = evaluations_done_ >= PlannedEvaluations(setup_.experiment)};
}

bool ArchiveSearch::AtBoundary() const {
  return evaluations_done_ % kSaveInterval == 0 || evaluations_done_ == PlannedEvaluations(setup_.experiment);
}

std::vector<std::pair<std::string, double>> ArchiveSearch::Statistics() const {
  std::vector<std::pair<std::string, double>> statistics = {
      {"cells_filled", static_cast<double>(archive_.shelves().size())}};
  for (std::size_t most = 3; most >= 1; --most) {
    const auto small = std::ranges::count_if(
        population_, [&](const Individual& elite) { return elite.test_case.obstacles.size() <= most; });
    statistics.emplace_back(fmt::format("cells_with_up_to_{}", most), static_cast<double>(small));
  }
  for (std::size_t i = 0; i < kEmitters; ++i) {
    const std::string_view name = NameOf(static_cast<Emitter>(i));
    statistics.emplace_back(fmt::format("{}_runs", name), static_cast<double>(accounts_[i].runs));
    statistics.emplace_back(fmt::format("{}_layouts", name), static_cast<double>(accounts_[i].layouts));
    statistics.emplace_back(fmt::format("{}_elites", name), static_cast<double>(accounts_[i].elites));
  }
  return statistics;
}

ArchiveView ArchiveSearch::Archive() const {
  ArchiveView view;
  view.axes = archive_.grid().axes();
  for (const auto& [cell, shelf] : archive_.shelves()) {
    const Finding& elite = shelf.front();
    view.failures.push_back({archive_.grid().PartsOf(cell), elite.Middle(), elite.individual.id,
                             elite.tally.failures, elite.tally.runs()});
  }
  return view;
}

void ArchiveSearch::Count(const EvaluationOutcome& outcome, Finding& finding) const {
  Record(outcome, finding.individual);
  for (const RunOutcome& run : outcome.runs) {
    finding.tally.Add(run, failing_);
    if (!Fails(run, failing_)) continue;
    if (std::optional<Descriptor> descriptor = archive_.grid().Describe(run)) {
      finding.failures.push_back(*std::move(descriptor));
    }
  }
}

void ArchiveSearch::Told(const EvaluationOutcome& outcome) {
  const std::size_t index = waiting_.front();
  waiting_.pop_front();
  --asked_;
  Slot& slot = slots_[index];
  FailureTally told;
  for (const RunOutcome& run : outcome.runs) told.Add(run, failing_);
  prior_.Learn(slot.finding.tally, told);
  Count(outcome, slot.finding);
  ++accounts_[static_cast<std::size_t>(slot.emitter)].runs;
  if (steered_) Remember(slot.finding.individual);
  Continue(slot);
  waiting_.push_back(index);
}

void ArchiveSearch::Remember(const Individual& individual) {
  std::erase_if(nearest_, [&](const Individual& one) { return one.id == individual.id; });
  const auto place = std::ranges::upper_bound(nearest_, individual.fitness, {}, &Individual::fitness);
  nearest_.insert(place, individual);
  if (nearest_.size() > kRemembered) nearest_.pop_back();
}

void ArchiveSearch::Continue(Slot& slot) {
  Finding& finding = slot.finding;
  if (slot.emitter == Emitter::kRecheck) {
    Rechecked(slot);
    return BeginAnew(slot);
  }
  const bool first_run = finding.tally.runs() + finding.tally.errors == spec().replicates;
  Race race = ArchiveJudge::OfRuns(finding);
  if (race != Race::kDrop && !only_deletion_ && slot.emitter == Emitter::kRandom && first_run) {
    PlanNearest(slot);
    if (BeginPlanned(slot)) return;
    return BeginAnew(slot);
  }
  if (race != Race::kDrop) race = judge_.InItsCell(finding, Late());
  if (race == Race::kOpen) return;
  if (race == Race::kAdmit) {
    slot.plan.clear();
    slot.root.reset();
    PlanWithout(slot, finding);
    if (archive_.Add(std::move(finding))) ++accounts_[static_cast<std::size_t>(slot.emitter)].elites;
    UpdatePopulation();
  }
  if (!BeginPlanned(slot)) BeginAnew(slot);
}

void ArchiveSearch::Rechecked(Slot& slot) {
  Finding& elite = slot.finding;
  const bool stays = judge_.Stays(elite, Late());
  if (Late()) elite.mirrored = false;
  if (stays) archive_.Add(std::move(elite));
  UpdatePopulation();
}

void ArchiveSearch::PlanNearest(Slot& slot) {
  const Individual& random_case = slot.finding.individual;
  const Descriptor& failure = slot.finding.failures.front();
  slot.cell = archive_.grid().CellOf(failure);
  slot.parent = random_case.id;
  for (sim::Genome& part : proposer_.PartsNear(random_case.test_case.obstacles, failure)) {
    slot.plan.push_back({Emitter::kNearest, std::move(part)});
  }
  slot.root = std::move(slot.finding);
}

void ArchiveSearch::PlanWithout(Slot& slot, const Finding& found) {
  const sim::Genome& obstacles = found.individual.test_case.obstacles;
  slot.cell = archive_.grid().CellOf(found.Middle());
  slot.parent = found.individual.id;
  if (obstacles.size() < 2 || slot.emitter == Emitter::kMirrored) return;
  for (sim::Genome& part : proposer_.PartsWithoutOne(obstacles, found.Middle())) {
    slot.plan.push_back({Emitter::kWithout, std::move(part)});
  }
}

bool ArchiveSearch::Begin(Slot& slot, std::optional<Proposal> proposal) {
  if (!proposal) return false;
  slot.emitter = proposal->emitter;
  if (proposal->cell) slot.cell = *proposal->cell;
  slot.finding = {};
  Individual& individual = slot.finding.individual;
  individual = MakeIndividual(next_id_++, generator_.WithObstacles(std::move(proposal->obstacles)));
  if (proposal->parent != 0) individual.parents = {proposal->parent};
  ++accounts_[static_cast<std::size_t>(slot.emitter)].layouts;
  return true;
}

bool ArchiveSearch::BeginPlanned(Slot& slot) {
  while (!slot.plan.empty()) {
    auto [emitter, obstacles] = std::move(slot.plan.front());
    slot.plan.pop_front();
    if (!judge_.Matters(slot.cell, SizeOf(obstacles))) continue;
    return Begin(slot, Proposal{emitter, std::move(obstacles), slot.parent});
  }
  if (!slot.root || !archive_.WouldWin(slot.cell, slot.root->size())) return false;
  slot.finding = *std::move(slot.root);
  slot.emitter = Emitter::kRandom;
  slot.root.reset();
  return true;
}

void ArchiveSearch::BeginAnew(Slot& slot) {
  slot.plan.clear();
  slot.root.reset();
  if (!only_deletion_ && BeginRecheck(slot, ArchiveJudge::kBeyondDoubt)) return;
  if (places_ && Begin(slot, proposer_.Mirrored())) return;
  sim::RandomStream random(search_seed_, sim::StreamPurpose::kVariation,
                           static_cast<std::uint32_t>(evaluations_done_),
                           static_cast<std::uint32_t>(&slot - slots_.data()));
  if (!only_deletion_ && BeginDrawn(slot, random)) return;
  Begin(slot, proposer_.Random(random));
}

bool ArchiveSearch::BeginDrawn(Slot& slot, sim::RandomStream& random) {
  if (steered_ && archive_.shelves().empty() && !nearest_.empty() && random.Uniform() < kSteeredShare) {
    const std::uint32_t index = random.Below(static_cast<std::uint32_t>(nearest_.size()));
    if (Begin(slot, proposer_.Changed(nearest_[index], random))) return true;
  }
  const double draw = random.Uniform();
  const Experiment& e = setup_.experiment;
  const double across = proposer_.HasWay() ? Get(e, kAcrossShare) : 0.0;
  const double jittered = across + Get(e, kJitteredShare);
  const double recheck = jittered + Get(e, kRecheckShare);
  if (draw < across) return Begin(slot, proposer_.Across(Late(), random));
  if (draw >= recheck || archive_.shelves().empty()) return false;
  return draw < jittered ? Begin(slot, proposer_.Jittered(random)) : BeginRecheck(slot, 1.0);
}

bool ArchiveSearch::BeginRecheck(Slot& slot, double below) {
  const Finding* worst = judge_.MostDoubtful(below);
  if (worst == nullptr) return false;
  slot.finding = archive_.Take(worst->individual.id);
  slot.emitter = Emitter::kRecheck;
  ++accounts_[static_cast<std::size_t>(Emitter::kRecheck)].layouts;
  return true;
}

void ArchiveSearch::UpdatePopulation() {
  population_.clear();
  for (const auto& [size, shelf] : archive_.shelves()) {
    population_.push_back(shelf.front().individual);
  }
}

void ArchiveSearch::SaveFinding(const Finding& finding, CanonicalEncoder& encoder) {
  SaveIndividuals({finding.individual}, encoder);
  encoder.Int(finding.tally.failures);
  encoder.Int(finding.tally.passes);
  encoder.Int(finding.tally.errors);
  encoder.Bool(finding.mirrored);
  encoder.Uint(finding.failures.size());
  for (const Descriptor& failure : finding.failures) {
    for (const double value : failure) encoder.Double(value);
  }
}

Result<Finding> ArchiveSearch::RestoreFinding(CanonicalDecoder& decoder) const {
  TRY(auto individual, RestoreIndividuals(1, next_id_, decoder));
  Finding finding;
  finding.individual = std::move(individual.front());
  finding.tally.failures = static_cast<int>(decoder.Int());
  finding.tally.passes = static_cast<int>(decoder.Int());
  finding.tally.errors = static_cast<int>(decoder.Int());
  finding.mirrored = decoder.Bool();
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    Descriptor& failure = finding.failures.emplace_back(archive_.grid().axes().size());
    for (double& value : failure) value = decoder.Double();
  }
  return finding;
}

void ArchiveSearch::SaveSlot(const Slot& slot, CanonicalEncoder& encoder) {
  encoder.Uint(static_cast<std::uint64_t>(slot.emitter));
  encoder.Uint(slot.cell);
  encoder.Uint(slot.parent);
  SaveFinding(slot.finding, encoder);
  encoder.Bool(slot.root.has_value());
  if (slot.root) SaveFinding(*slot.root, encoder);
  encoder.Uint(slot.plan.size());
  for (const Step& step : slot.plan) {
    encoder.Uint(static_cast<std::uint64_t>(step.emitter));
    sim::EncodeGenome(step.obstacles, encoder);
  }
}

Status ArchiveSearch::RestoreSlot(CanonicalDecoder& decoder, Slot& slot) const {
  slot.plan.clear();
  slot.root.reset();
  const std::optional<Emitter> emitter = RestoreEmitter(decoder);
  if (!emitter) return Damaged("a layout comes from nowhere");
  slot.emitter = *emitter;
  slot.cell = decoder.Uint();
  slot.parent = decoder.Uint();
  TRY(slot.finding, RestoreFinding(decoder));
  if (decoder.Bool()) {
    TRY(slot.root, RestoreFinding(decoder));
  }
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    const std::optional<Emitter> planned = RestoreEmitter(decoder);
    if (!planned) return Damaged("a planned layout comes from nowhere");
    slot.plan.push_back({*planned, sim::DecodeGenome(decoder)});
  }
  return Ok{};
}

void ArchiveSearch::SaveRest(CanonicalEncoder& encoder) const {
  encoder.Uint(next_id_);
  for (const EmitterAccount& account : accounts_) {
    encoder.Uint(account.runs);
    encoder.Uint(account.layouts);
    encoder.Uint(account.elites);
  }
  encoder.Uint(archive_.shelves().size());
  for (const auto& [cell, shelf] : archive_.shelves()) {
    encoder.Uint(cell);
    encoder.Uint(shelf.size());
    for (const Finding& finding : shelf) SaveFinding(finding, encoder);
  }
  for (const Slot& slot : slots_) SaveSlot(slot, encoder);
  for (const std::size_t slot : waiting_) encoder.Uint(slot);
  prior_.Save(encoder);
  if (!steered_) return;
  encoder.Uint(nearest_.size());
  SaveIndividuals(nearest_, encoder);
}

Status ArchiveSearch::RestoreRest(CanonicalDecoder& decoder, const History& /*history*/) {
  next_id_ = decoder.Uint();
  for (EmitterAccount& account : accounts_) {
    account.runs = decoder.Uint();
    account.layouts = decoder.Uint();
    account.elites = decoder.Uint();
  }
  FailureArchive::Shelves shelves;
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    std::vector<Finding>& shelf = shelves[decoder.Uint()];
    for (std::uint64_t findings = decoder.Uint(); findings > 0 && decoder.ok(); --findings) {
      TRY(auto finding, RestoreFinding(decoder));
      shelf.push_back(std::move(finding));
    }
    if (shelf.empty()) return Damaged("a cell of its archive is empty");
  }
  if (!shelves.empty() && shelves.rbegin()->first >= archive_.grid().cells()) {
    return Damaged("its archive has a cell that is none");
  }
  archive_.Restore(std::move(shelves));
  for (Slot& slot : slots_) {
    TRY(RestoreSlot(decoder, slot));
  }
  for (std::size_t& slot : waiting_) {
    slot = decoder.Uint();
    if (slot >= slots_.size()) return Damaged(fmt::format("slot {} waits", slot));
  }
  if (!decoder.AtEnd()) prior_.Restore(decoder);  // states of earlier versions end here
  if (steered_) {
    const std::uint64_t remembered = decoder.Uint();
    TRY(nearest_, RestoreIndividuals(remembered, next_id_, decoder));
  }
  if (std::set<std::size_t>(waiting_.begin(), waiting_.end()).size() != slots_.size()) {
    return Damaged("a slot does not wait");
  }
  asked_ = 0;
  UpdatePopulation();
  return Ok{};
}

SearchRow ArchiveRow() {
  return {.info = {.name = "archive",
                   .description = "many different failures, each with as few obstacles as possible",
                   .keys = {"search.replicates", "search.cells", "search.objective", "genome."},
                   .parameters = kArchiveParameters,
                   .length = "search.runs",
                   .check = CheckArchive},
          .number = 8,
          .title = "archive search",
          .individuals = Individuals::kElites,
          .plan = PlanOfRuns,
          .make = Make<ArchiveSearch>};
}

SearchRow RandomDeletionRow() {
  return {
      .info = {.name = "random-deletion",
               .description = "random cases and, as long as they fail, without one obstacle after the other",
               .keys = {"search.replicates", "search.cells", "search.runs", "search.slots", "search.keep_out",
                        "genome."},
               .length = "search.runs",
               .check = CheckBudget},
      .number = 9,
      .title = "random search with deletion",
      .individuals = Individuals::kElites,
      .plan = PlanOfRuns,
      .make = Make<ArchiveSearch, LinePolicy::kDeletionOnly>};
}

}  // namespace gauntlet
