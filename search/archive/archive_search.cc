#include "search/archive/archive_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number_text.h"
#include "search/experiment/failure_cells.h"
#include "sim/arena/genome.h"

namespace gauntlet {
namespace {

constexpr std::array kArchiveParameters = std::to_array<controllers::ParameterInfo>({
    {"runs", "", 1000, 1, 1e8, true, "archive and random-deletion only: simulations in all"},
    {"slots", "", 36, 1, 10000, true,
     "archive and random-deletion only: layouts under test at a time; workers it can keep busy"},
    {"keep_out", "m", 0, 0, 10, false,
     "archive and random-deletion only: no obstacle nearer than this to where the swarm starts and arrives"},
    {"alone_share", "", 0.60, 0, 1, false,
     "archive only: of the lines that begin, with one to three obstacles alone, across the way to the goal"},
    {"jittered_share", "", 0.10, 0, 1, false,
     "archive only: of the lines that begin, with an elite that is changed a little"},
    {"recheck_share", "", 0.04, 0, 1, false,
     "archive only: of the lines that begin, one more run of an elite; the rest begin with random cases"},
});
enum Parameter : std::size_t { kRuns, kSlots, kKeepOut, kAcrossShare, kJitteredShare, kRecheckShare };

double Get(const Experiment& experiment, Parameter parameter) {
  return ValueOf(kArchiveParameters[parameter], experiment.search.parameters);
}

constexpr std::string_view kRandomDeletion = "random-deletion";

std::string PlanOf(const Experiment& experiment) {
  return FormatCount(static_cast<std::uint64_t>(Get(experiment, kRuns))) + " runs";
}

// A case is admitted after so many failures at the earliest.
constexpr int kFewestFailures = 3;

std::optional<BrokenRule> CheckArchive(const Experiment& experiment) {
  if (std::optional<BrokenRule> cells = CheckCells(experiment)) return cells;
  const int replicates = experiment.search.replicates;
  const int rounds = (kFewestFailures + replicates - 1) / replicates;
  const double needed = ((rounds - 1) * Get(experiment, kSlots) + 1) * replicates;
  if (Get(experiment, kRuns) >= needed) return std::nullopt;
  return BrokenRule{
      "search.runs",
      fmt::format("search.runs = {} cannot fill a cell: a case has to fail in {} runs, and all "
                  "search.slots = {} cases have a run before one of them has its next; use {} runs or more, "
                  "or fewer slots",
                  Get(experiment, kRuns), kFewestFailures, Get(experiment, kSlots), needed)};
}

// To take the place of an elite of as many obstacles: of many that are tried some fail three times by luck.
constexpr int kFailuresToShorten = 5;
constexpr int kMaxRuns = 8;                   // of an elite; then it is known well enough
constexpr double kReliable = 0.6;             // of its runs an elite has to be expected to fail
constexpr double kBeyondDoubt = 0.8;          // with less it is run again before anything new begins
constexpr std::ptrdiff_t kMostElsewhere = 1;  // failures of a layout outside its cell, when it is admitted
constexpr std::ptrdiff_t kEnoughWithOneElsewhere = 5;

Race Judge(const FailureTally& tally) {
  const int passes = tally.passes + tally.errors;
  if (tally.failures == 0 || passes >= 2) return Race::kDrop;
  if ((tally.failures >= kFewestFailures && passes == 0) || tally.failures >= 4) return Race::kAdmit;
  return Race::kOpen;
}

}  // namespace

std::string_view NameOf(Emitter emitter) {
  constexpr std::array<std::string_view, kEmitters> names = {"random", "nearest",  "without", "mirrored",
                                                             "across", "jittered", "recheck"};
  return names[static_cast<std::size_t>(emitter)];
}

ArchiveSearch::ArchiveSearch(const SearchSetup& setup, const controllers::ScenarioInfo& scenario)
    : PopulationSearch(setup),
      only_deletion_(setup.experiment.search.algorithm == kRandomDeletion),
      failing_(scenario.failing),
      requirements_(setup.requirements),
      way_{setup.requirements.start, setup.requirements.goal},
      archive_(CellsOf(setup.experiment)),
      slots_(static_cast<std::size_t>(Get(setup.experiment, kSlots))) {
  const std::vector<CellAxis>& axes = archive_.grid().axes();
  places_ = !only_deletion_ && scenario.failure_place && axes.size() == 2 &&
            axes[0].metric == scenario.failure_place->x && axes[1].metric == scenario.failure_place->y;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    BeginAnew(slots_[i]);
    waiting_.push_back(i);
  }
}

Result<std::unique_ptr<ArchiveSearch>> ArchiveSearch::Create(const SearchSetup& setup) {
  const Experiment& experiment = setup.experiment;
  const controllers::ScenarioInfo* scenario =
      controllers::FindScenario(experiment.scenario, experiment.scenario_plugin);
  GAUNTLET_CHECK(scenario != nullptr, experiment.scenario);
  if (CellsOf(setup.experiment).empty()) {
    return InvalidInput(
        fmt::format("scenario {} does not say along which metrics its failures differ, which "
                    "search.algorithm = \"{}\" needs: search.cells does",
                    scenario->name, setup.experiment.search.algorithm));
  }
  if (experiment.genome.genes < 1) {
    return InvalidInput(
        fmt::format("genome.genes = {}: search.algorithm = \"{}\" looks for obstacles that break the swarm; "
                    "allow 1 or more",
                    experiment.genome.genes, experiment.search.algorithm));
  }
  SearchSetup kept_out = setup;
  double& clearance = kept_out.requirements.clearance;
  clearance = std::max(clearance, Get(setup.experiment, kKeepOut));
  sim::RandomStream random = GenomeStream(SearchSeed(setup), 1);
  TRY(MakeGenerator(kept_out).RandomTestCase(random));
  return std::unique_ptr<ArchiveSearch>(new ArchiveSearch(kept_out, *scenario));
}

std::uint64_t ArchiveSearch::Planned() const {
  const auto replicates = static_cast<std::uint64_t>(spec().replicates);
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(Get(setup_.experiment, kRuns)) / replicates);
}

std::vector<EvaluationRequest> ArchiveSearch::Ask() {
  std::vector<EvaluationRequest> requests;
  for (; asked_ < waiting_.size() && evaluations_done_ + asked_ < Planned(); ++asked_) {
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
          .evaluations_planned = Planned(),
          .individuals_planned = next_id_ - 1,
          .finished = evaluations_done_ >= Planned()};
}

bool ArchiveSearch::AtBoundary() const {
  return evaluations_done_ % kSaveInterval == 0 || evaluations_done_ == Planned();
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
  Continue(slot);
  waiting_.push_back(index);
}

void ArchiveSearch::Continue(Slot& slot) {
  Finding& finding = slot.finding;
  if (slot.emitter == Emitter::kRecheck) {
    Rechecked(slot);
    return BeginAnew(slot);
  }
  const bool first_run = finding.tally.runs() + finding.tally.errors == spec().replicates;
  Race race = Judge(finding.tally);
  if (finding.failures.empty()) race = Race::kDrop;  // nothing to say in which cell it belongs
  if (race != Race::kDrop && !only_deletion_ && slot.emitter == Emitter::kRandom && first_run) {
    PlanNearest(slot);
    if (BeginPlanned(slot)) return;
    return BeginAnew(slot);
  }
  if (race != Race::kDrop && !Matters(archive_.grid().CellOf(finding.Middle()), finding.size())) {
    race = Race::kDrop;
  }
  if (race == Race::kAdmit) race = JudgePlace(finding);
  if (race == Race::kAdmit && !only_deletion_) race = JudgeShortening(finding);
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

bool ArchiveSearch::Matters(std::size_t cell, const LayoutSize& size) const {
  return only_deletion_ || archive_.WouldWin(cell, size);
}

Race ArchiveSearch::JudgeShortening(const Finding& finding) const {
  const Finding* elite = archive_.EliteOf(archive_.grid().CellOf(finding.Middle()));
  if (elite == nullptr || elite->size().obstacles != finding.size().obstacles) return Race::kAdmit;
  if (finding.tally.failures < kFailuresToShorten) return Race::kOpen;
  if (!Late() || prior_.Expected(finding.tally) >= prior_.Expected(elite->tally)) return Race::kAdmit;
  return finding.tally.runs() + finding.tally.errors < kMaxRuns ? Race::kOpen : Race::kDrop;
}

Race ArchiveSearch::JudgePlace(const Finding& finding) const {
  const std::size_t cell = archive_.grid().CellOf(finding.Middle());
  const auto elsewhere = std::ranges::count_if(
      finding.failures, [&](const Descriptor& failure) { return archive_.grid().CellOf(failure) != cell; });
  if (elsewhere == 0) return Race::kAdmit;
  if (elsewhere > kMostElsewhere) return Race::kDrop;
  return std::ssize(finding.failures) >= kEnoughWithOneElsewhere ? Race::kAdmit : Race::kOpen;
}

void ArchiveSearch::Rechecked(Slot& slot) {
  Finding& elite = slot.finding;
  const double expected = prior_.Expected(elite.tally);
  const Finding* next = archive_.EliteOf(archive_.grid().CellOf(elite.Middle()));
  const bool gives_way = Late() && next != nullptr && next->size().obstacles <= elite.size().obstacles &&
                         expected < kBeyondDoubt && expected < prior_.Expected(next->tally);
  if (Late()) elite.mirrored = false;
  if (expected >= kReliable && !gives_way) archive_.Add(std::move(elite));
  UpdatePopulation();
}

void ArchiveSearch::Begin(Slot& slot, Emitter emitter, sim::Genome obstacles, IndividualId parent) {
  slot.emitter = emitter;
  slot.finding = {};
  slot.finding.individual = MakeIndividual(next_id_++, generator_.WithObstacles(std::move(obstacles)));
  if (parent != 0) slot.finding.individual.parents = {parent};
  ++accounts_[static_cast<std::size_t>(emitter)].layouts;
}

bool ArchiveSearch::BeginPlanned(Slot& slot) {
  while (!slot.plan.empty()) {
    Step step = std::move(slot.plan.front());
    slot.plan.pop_front();
    if (!Matters(slot.cell, SizeOf(step.obstacles))) continue;
    Begin(slot, step.emitter, std::move(step.obstacles), slot.parent);
    return true;
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
  if (!only_deletion_ && BeginRecheck(slot, kBeyondDoubt)) return;
  if (places_ && BeginMirrored(slot)) return;
  sim::RandomStream random(search_seed_, sim::StreamPurpose::kVariation,
                           static_cast<std::uint32_t>(evaluations_done_),
                           static_cast<std::uint32_t>(&slot - slots_.data()));
  if (!only_deletion_ && BeginDrawn(slot, random)) return;
  BeginRandom(slot, random);
}

bool ArchiveSearch::BeginDrawn(Slot& slot, sim::RandomStream& random) {
  const double draw = random.Uniform();
  const Experiment& e = setup_.experiment;
  const double across = way_.start != way_.goal ? Get(e, kAcrossShare) : 0.0;
  const double jittered = across + Get(e, kJitteredShare);
  const double recheck = jittered + Get(e, kRecheckShare);
  if (draw < across) return BeginAcross(slot, random);
  if (draw >= recheck || archive_.shelves().empty()) return false;
  return draw < jittered ? BeginJittered(slot, random) : BeginRecheck(slot, 1.0);
}

bool ArchiveSearch::BeginRecheck(Slot& slot, double below) {
  const Finding* worst = nullptr;
  double least = below;
  for (const auto& [size, shelf] : archive_.shelves()) {
    const Finding& elite = shelf.front();
    const double expected = prior_.Expected(elite.tally);
    if (elite.tally.runs() >= kMaxRuns || expected >= least) continue;
    least = expected;
    worst = &elite;
  }
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

SearchRow ArchiveRow() {
  return {.info = {.name = "archive",
                   .description = "many different failures, each with as few obstacles as possible",
                   .keys = {"search.replicates", "search.cells", "genome."},
                   .parameters = kArchiveParameters,
                   .length = "search.runs",
                   .check = CheckArchive},
          .number = 8,
          .title = "archive search",
          .members = "elites",
          .plan = PlanOf,
          .make = Make<ArchiveSearch>};
}

SearchRow RandomDeletionRow() {
  return {
      .info = {.name = kRandomDeletion,
               .description = "random cases and, as long as they fail, without one obstacle after the other",
               .keys = {"search.replicates", "search.cells", "search.runs", "search.slots", "search.keep_out",
                        "genome."},
               .length = "search.runs",
               .check = CheckArchive},
      .number = 9,
      .title = "random search with deletion",
      .members = "elites",
      .plan = PlanOf,
      .make = Make<ArchiveSearch>};
}

}  // namespace gauntlet
