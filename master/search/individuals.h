// What searches do with individuals and requests alike: keep accounts of evaluations, and encode them.
#pragma once

#include <cstdint>
#include <deque>

#include "base/canonical_encoder.h"
#include "master/experiment/experiment.h"
#include "master/search/search_algorithm.h"

namespace gauntlet::master {

// A newborn with no evaluation: its fitness is +infinity.
Individual MakeIndividual(IndividualId id, sim::TestCase test_case);

// The individual's next evaluation, with the number that follows its last one.
EvaluationRequest NextEvaluation(const Individual& individual, int replicates, std::uint32_t generation);

// Whether the outcome has a fitness: completed and finite (a controller under test may return anything).
bool HasFitness(const EvaluationOutcome& outcome);

// Adds the outcome to the individual's account and aggregates its fitness anew. An evaluation without fitness
// is counted as failed and left out of the aggregate.
void RecordOutcome(const EvaluationOutcome& outcome, FitnessAggregation aggregation, Individual& individual);

// Everything but the arena, which is the experiment's. The fitness is not stored but aggregated again.
void EncodeIndividual(const Individual& individual, CanonicalEncoder& encoder);
// The genome stands in test_case.obstacles; check decoder.ok() before use.
Individual DecodeIndividual(FitnessAggregation aggregation, CanonicalDecoder& decoder);

// Requests that were asked and not yet told. Outcomes must come in the order of the requests.
class PendingRequests {
 public:
  void Add(const EvaluationRequest& request) {
    requests_.push_back({request.individual, request.evaluation});
  }
  // Aborts when `outcome` is not the answer to the oldest request.
  void Settle(const EvaluationOutcome& outcome);
  bool empty() const { return requests_.empty(); }
  std::size_t size() const { return requests_.size(); }

 private:
  struct Entry {
    IndividualId individual;
    std::uint32_t evaluation;
  };
  std::deque<Entry> requests_;
};

}  // namespace gauntlet::master
