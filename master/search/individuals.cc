#include "master/search/individuals.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"
#include "base/hash.h"
#include "sim/arena/genome_codec.h"

namespace gauntlet::master {
namespace {

double Aggregate(const std::vector<double>& evaluations, FitnessAggregation aggregation) {
  if (evaluations.empty()) return std::numeric_limits<double>::infinity();
  if (aggregation == FitnessAggregation::kLast) return evaluations.back();
  double sum = 0.0;
  for (const double fitness : evaluations) sum += fitness;
  return sum / static_cast<double>(evaluations.size());
}

}  // namespace

Individual MakeIndividual(IndividualId id, sim::TestCase test_case) {
  Individual individual;
  individual.id = id;
  individual.birth_generation = 1;
  individual.test_case = std::move(test_case);
  individual.fitness = std::numeric_limits<double>::infinity();
  return individual;
}

EvaluationRequest NextEvaluation(const Individual& individual, int replicates, std::uint32_t generation) {
  return {
      .individual = individual.id,
      .evaluation = static_cast<std::uint32_t>(individual.evaluations.size()) + individual.failed_evaluations,
      .replicates = static_cast<std::uint32_t>(replicates),
      .generation = generation,
      .test_case = individual.test_case,
      .parents = individual.parents};
}

bool HasFitness(const EvaluationOutcome& outcome) {
  return outcome.completed && std::isfinite(outcome.fitness);
}

void RecordOutcome(const EvaluationOutcome& outcome, FitnessAggregation aggregation, Individual& individual) {
  if (HasFitness(outcome)) {
    individual.evaluations.push_back(outcome.fitness);
  } else {
    ++individual.failed_evaluations;
  }
  individual.fitness = Aggregate(individual.evaluations, aggregation);
}

void EncodeIndividual(const Individual& individual, CanonicalEncoder& encoder) {
  encoder.Uint(individual.id);
  encoder.Uint(individual.parents.size());
  for (const IndividualId parent : individual.parents) encoder.Uint(parent);
  encoder.Uint(individual.birth_generation);
  sim::EncodeGenome(individual.test_case.obstacles, encoder);
  encoder.Uint(individual.evaluations.size());
  for (const double fitness : individual.evaluations) encoder.Double(fitness);
  encoder.Uint(individual.failed_evaluations);
}

Individual DecodeIndividual(FitnessAggregation aggregation, CanonicalDecoder& decoder) {
  Individual individual;
  individual.id = decoder.Uint();
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    individual.parents.push_back(decoder.Uint());
  }
  individual.birth_generation = static_cast<std::uint32_t>(decoder.Uint());
  individual.test_case.obstacles = sim::DecodeGenome(decoder);
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    individual.evaluations.push_back(decoder.Double());
  }
  individual.failed_evaluations = static_cast<std::uint32_t>(decoder.Uint());
  individual.fitness = Aggregate(individual.evaluations, aggregation);
  return individual;
}

void PendingRequests::Settle(const EvaluationOutcome& outcome) {
  GAUNTLET_CHECK(!requests_.empty(), fmt::format("individual {} was not asked for", outcome.individual));
  const Entry expected = requests_.front();
  GAUNTLET_CHECK(
      outcome.individual == expected.individual && outcome.evaluation == expected.evaluation,
      fmt::format("told individual {} evaluation {}, expected {} evaluation {}", outcome.individual,
                  outcome.evaluation, expected.individual, expected.evaluation));
  requests_.pop_front();
}

}  // namespace gauntlet::master
