#include "search/evolution/population_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include "base/check.h"
#include "base/mean_and_range.h"
#include "controllers/requirements/requirements.h"
#include "search/failure_tally.h"
#include "search/search_row.h"
#include "sim/arena/genome.h"

namespace gauntlet {
namespace {

// Marks the beginning of a state: "GNT_SRCH" in the bytes of the file.
constexpr std::uint64_t kStateMagic = 0x485243535F544E47ULL;
// Raise it whenever the encoding or the meaning of any search's state changes.
constexpr std::uint64_t kStateFormat = 2;

Error Mismatch(const std::string& saved, const std::string& here) {
  std::istringstream saved_lines(saved);
  std::istringstream here_lines(here);
  std::string saved_line;
  std::string here_line;
  do {  // of the shorter text, the line behind its last one is empty
    std::getline(saved_lines, saved_line);
    std::getline(here_lines, here_line);
  } while (saved_line == here_line && (saved_lines || here_lines));
  return InvalidInput(
      fmt::format("the saved search state belongs to another experiment: it has '{}', this one has '{}'",
                  saved_line, here_line));
}

void EncodeIndividual(const Individual& individual, CanonicalEncoder& encoder) {
  encoder.Uint(individual.id);
  encoder.Uint(individual.parents.size());
  for (const IndividualId parent : individual.parents) encoder.Uint(parent);
  encoder.Uint(individual.birth_generation);
  sim::EncodeGenome(individual.test_case.obstacles, encoder);
  encoder.Uint(individual.evaluations);
  encoder.Uint(individual.failed_evaluations);
  encoder.Double(individual.fitness_sum);
  encoder.Double(individual.fitness);
}

// The genome stands in test_case.obstacles.
Individual DecodeIndividual(CanonicalDecoder& decoder) {
  Individual individual;
  individual.id = decoder.Uint();
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    individual.parents.push_back(decoder.Uint());
  }
  individual.birth_generation = static_cast<std::uint32_t>(decoder.Uint());
  individual.test_case.obstacles = sim::DecodeGenome(decoder);
  individual.evaluations = static_cast<std::uint32_t>(decoder.Uint());
  individual.failed_evaluations = static_cast<std::uint32_t>(decoder.Uint());
  individual.fitness_sum = decoder.Double();
  individual.fitness = decoder.Double();
  return individual;
}

}  // namespace

double RobustnessOf(const EvaluationOutcome& outcome) {
  constexpr double kOfAFailure = -1.0;
  double sum = 0.0;
  for (const RunOutcome& run : outcome.runs)
    sum +=
        controllers::ReportedValue(run.metrics, controllers::requirements::kRobustness).value_or(kOfAFailure);
  return sum / static_cast<double>(outcome.runs.size());
}

SideEffects SideEffectsOf(const sim::RunResult& result) {
  SideEffects effects{.contacts = static_cast<double>(result.contacts),
                      .seconds = static_cast<double>(result.ticks) / sim::kTicksPerSecond};
  for (const sim::RobotSummary& robot : result.robots) effects.distance += robot.path_length;
  return effects;
}

EvaluationOutcome OutcomeOfRuns(IndividualId individual, std::uint32_t evaluation,
                                std::vector<RunOutcome> runs) {
  EvaluationOutcome outcome{.individual = individual, .evaluation = evaluation, .runs = std::move(runs)};
  MeanAndRange completed;
  for (const RunOutcome& run : outcome.runs) {
    if (run.verdict == sim::Verdict::kCompleted) completed.Add(run.fitness);
  }
  outcome.completed = completed.count() > 0;
  if (outcome.completed) outcome.fitness = completed.mean();
  return outcome;
}

std::optional<BrokenRule> CheckObjective(const Experiment& experiment) {
  if (ObjectiveOf(experiment.search) == Objective::kRobustness && experiment.requirements.empty()) {
    return BrokenRule{"search.objective",
                      "search.objective = \"robustness\" is of what must hold: say it in [requirements]"};
  }
  if (ObjectiveOf(experiment.search) != Objective::kSmallestFailure) return std::nullopt;
  const GenomeSpec& genome = experiment.genome;
  if (genome.genes > 0 && genome.length_min < genome.length_max) return std::nullopt;
  return BrokenRule{
      "search.objective",
      fmt::format("search.objective = \"smallest-failure\" tells test cases apart by how long their "
                  "obstacles are, and genome.genes = {} of {} to {} m (genome.length_min, length_max) "
                  "are all as long: use \"failure-probability\"",
                  genome.genes, genome.length_min, genome.length_max)};
}

std::uint64_t CountDistinctGenomes(const std::vector<Individual>& individuals) {
  std::vector<std::uint64_t> genomes;
  genomes.reserve(individuals.size());
  for (const Individual& one : individuals) genomes.push_back(GenomeHash(one.test_case.obstacles));
  std::ranges::sort(genomes);
  return static_cast<std::uint64_t>(std::unique(genomes.begin(), genomes.end()) - genomes.begin());
}

PopulationSearch::PopulationSearch(SearchSetup setup)
    : setup_(std::move(setup)),
      generator_(MakeGenerator(setup_)),
      search_seed_(SearchSeed(setup_)),
      objective_(Reads(setup_.row->info, "search.objective") ? ObjectiveOf(setup_.experiment.search)
                                                             : Objective::kFitness),
      identity_(SearchIdentity(setup_)) {}

Individual PopulationSearch::MakeIndividual(IndividualId id, sim::TestCase test_case) {
  Individual individual;
  individual.id = id;
  individual.birth_generation = 1;
  individual.test_case = std::move(test_case);
  individual.fitness = std::numeric_limits<double>::infinity();
  return individual;
}

Result<sim::TestCase> PopulationSearch::DrawCase(IndividualId id) const {
  sim::RandomStream random = GenomeStream(search_seed_, id);
  return generator_.RandomTestCase(random);
}

EvaluationRequest PopulationSearch::Request(const Individual& individual, std::uint32_t generation,
                                            std::uint32_t ahead) {
  const std::uint32_t evaluation = individual.evaluations + individual.failed_evaluations + ahead;
  pending_.push_back({individual.id, evaluation});
  return {.individual = individual.id,
          .evaluation = evaluation,
          .replicates = static_cast<std::uint32_t>(spec().replicates),
          .generation = generation,
          .test_case = individual.test_case,
          .parents = individual.parents};
}

bool PopulationSearch::WantsMetrics() const {
  if (objective_ == Objective::kRobustness) return true;
  return objective_ != Objective::kFitness && FailingNeedsMetrics(FailingOf(setup_.experiment));
}

double PopulationSearch::FitnessOf(const EvaluationOutcome& outcome, const sim::Genome& obstacles) const {
  if (objective_ == Objective::kFitness) return outcome.fitness;
  if (objective_ == Objective::kRobustness) return RobustnessOf(outcome);
  double of_failure = 0.0;
  if (objective_ == Objective::kSmallestFailure) {
    const GenomeSpec& genome = setup_.experiment.genome;
    for (const sim::ObstacleGene& gene : obstacles) of_failure += gene.length;
    of_failure /= genome.genes * genome.length_max;
  }
  FailureTally tally;
  for (const RunOutcome& run : outcome.runs) tally.Add(run, FailingOf(setup_.experiment));
  return (tally.passes + tally.failures * of_failure) / tally.runs();
}

bool PopulationSearch::MostlyRefused(const EvaluationOutcome& outcome) const {
  if (!StartsProgram(setup_.experiment)) return false;
  const auto refused = std::ranges::count(outcome.runs, sim::Verdict::kRefused, &RunOutcome::verdict);
  return 2 * refused >= std::ssize(outcome.runs);
}

void PopulationSearch::Record(const EvaluationOutcome& outcome, Individual& individual) const {
  if (!outcome.completed || !std::isfinite(outcome.fitness) || MostlyRefused(outcome)) {
    ++individual.failed_evaluations;
    return;
  }
  const double fitness = FitnessOf(outcome, individual.test_case.obstacles);
  ++individual.evaluations;
  individual.fitness_sum += fitness;
  individual.fitness = spec().aggregation == FitnessAggregation::kLast
                           ? fitness
                           : individual.fitness_sum / individual.evaluations;
}

void PopulationSearch::Tell(const EvaluationOutcome& outcome) {
  GAUNTLET_CHECK(!pending_.empty(), fmt::format("individual {} was not asked for", outcome.individual));
  const Pending expected = pending_.front();
  GAUNTLET_CHECK(
      outcome.individual == expected.individual && outcome.evaluation == expected.evaluation,
      fmt::format("told individual {} evaluation {}, expected {} evaluation {}", outcome.individual,
                  outcome.evaluation, expected.individual, expected.evaluation));
  pending_.pop_front();
  ++evaluations_done_;
  Told(outcome);
}

void PopulationSearch::Save(CanonicalEncoder& encoder) const {
  GAUNTLET_CHECK(AtBoundary(), fmt::format("{} evaluations are outstanding", pending_.size()));
  encoder.Uint(kStateMagic);
  encoder.Uint(kStateFormat);
  encoder.String(identity_);
  encoder.Uint(evaluations_done_);
  SaveRest(encoder);
}

Status PopulationSearch::Restore(CanonicalDecoder& decoder, const History& history) {
  const std::uint64_t magic = decoder.Uint();
  const std::uint64_t format = decoder.Uint();
  if (!decoder.ok() || magic != kStateMagic) return Damaged("it has no valid beginning");
  if (format != kStateFormat) {
    return Error{
        ErrorKind::kVersion,
        fmt::format("the saved search state has format {}, this version reads {}", format, kStateFormat)};
  }
  const std::string identity = decoder.String();
  if (!decoder.ok()) return Damaged("it is cut off");
  if (identity != identity_) return Mismatch(identity, identity_);
  evaluations_done_ = decoder.Uint();
  const std::uint64_t planned = Progress().evaluations_planned;
  const auto length = std::ranges::find(setup_.keys, setup_.row->info.length, &Key::path);
  if (length != setup_.keys.end() && evaluations_done_ > planned) {
    return InvalidInput(
        fmt::format("the saved search state has {} evaluations, but the experiment ends after {}: {} = {}",
                    evaluations_done_, planned, length->path, ToToml(length->get(setup_.experiment))));
  }
  newborns_.clear();
  TRY(RestoreRest(decoder, history));
  return decoder.ok() ? Status(Ok{}) : Damaged("it is cut off");
}

Status PopulationSearch::Recall(const History& history,
                                const std::function<void(const EvaluationOutcome&)>& recall) const {
  std::uint64_t told = 0;
  bool known = true;  // only individuals that have been asked for
  TRY(history([&](const EvaluationOutcome& outcome) {
    known = known && outcome.individual >= 1 && outcome.individual <= evaluations_done_;
    if (known && ++told <= evaluations_done_) recall(outcome);
  }));
  if (known && told == evaluations_done_) return Ok{};
  return Damaged(
      fmt::format("it has seen {} evaluations, but the runs of {} are stored", evaluations_done_, told));
}

void PopulationSearch::SaveIndividuals(const std::vector<Individual>& individuals,
                                       CanonicalEncoder& encoder) {
  encoder.Uint(individuals.size());
  for (const Individual& individual : individuals) EncodeIndividual(individual, encoder);
}

Result<std::vector<Individual>> PopulationSearch::RestoreIndividuals(std::uint64_t count, IndividualId below,
                                                                     CanonicalDecoder& decoder) const {
  const std::uint64_t found = decoder.Uint();
  if (!decoder.ok() || found != count)
    return Damaged(fmt::format("{} individuals instead of {}", found, count));
  std::vector<Individual> individuals;
  for (std::uint64_t i = 0; i < count && decoder.ok(); ++i) {
    Individual& individual = individuals.emplace_back(DecodeIndividual(decoder));
    sim::Genome& genome = individual.test_case.obstacles;
    if (std::ssize(genome) > setup_.experiment.genome.genes || individual.id == 0 || individual.id >= below) {
      return Damaged(fmt::format("individual {} does not fit", individual.id));
    }
    individual.test_case = generator_.WithObstacles(std::move(genome));
  }
  return individuals;
}

Error PopulationSearch::Damaged(const std::string& what) {
  return {ErrorKind::kCorrupt, "the saved search state is damaged: " + what};
}

}  // namespace gauntlet
