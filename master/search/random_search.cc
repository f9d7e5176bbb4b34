#include "master/search/random_search.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "sim/arena/genome_codec.h"

namespace gauntlet::master {
namespace {

// Saved states begin with it. Raise it whenever the encoding or the meaning of a state changes.
constexpr std::uint64_t kStateFormat = 1;
// Cases drawn before the search starts, to find ranges that leave no room.
constexpr std::uint64_t kTrialCases = 20;

}  // namespace

RandomSearch::RandomSearch(const SearchSetup& setup)
    : setup_(setup), generator_(MakeGenerator(setup)), search_seed_(SearchSeed(setup)) {}

Result<std::unique_ptr<RandomSearch>> RandomSearch::Create(const SearchSetup& setup) {
  std::unique_ptr<RandomSearch> search(new RandomSearch(setup));
  for (IndividualId id = 1; id <= std::min(kTrialCases, search->Planned()); ++id) {
    sim::RandomStream random = GenomeStream(search->search_seed_, id);
    const Result<sim::TestCase> trial = search->generator_.RandomTestCase(random);
    if (!trial.ok()) return trial.error();
  }
  return search;
}

Individual RandomSearch::DrawCase(IndividualId id) const {
  sim::RandomStream random = GenomeStream(search_seed_, id);
  while (true) {
    Result<sim::TestCase> test_case = generator_.RandomTestCase(random);
    if (test_case.ok()) return MakeIndividual(id, std::move(*test_case));
  }
}

std::vector<EvaluationRequest> RandomSearch::Ask() {
  std::vector<EvaluationRequest> requests;
  if (pending_.size() >= kLookahead) return requests;
  if (cases_.size() % kSaveInterval == 0 && !pending_.empty()) return requests;
  const std::uint64_t until = std::min(Planned(), cases_.size() + kChunk);
  for (IndividualId id = cases_.size() + 1; id <= until; ++id) {
    cases_.push_back(DrawCase(id));
    newborns_.push_back(cases_.back());
    genomes_seen_.insert(GenomeHash(cases_.back().test_case.obstacles));
    requests.push_back(NextEvaluation(cases_.back(), setup_.experiment.search.replicates, 1));
    pending_.Add(requests.back());
  }
  return requests;
}

void RandomSearch::Tell(const EvaluationOutcome& outcome) {
  pending_.Settle(outcome);
  RecordOutcome(outcome, setup_.experiment.search.aggregation, cases_[outcome.individual - 1]);
  ++evaluations_done_;
}

SearchProgress RandomSearch::Progress() const {
  return {.generation = cases_.empty() ? 0U : 1U,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = Planned(),
          .finished = evaluations_done_ >= Planned()};
}

std::vector<std::pair<std::string, double>> RandomSearch::Statistics() const {
  return {{"distinct_individuals", static_cast<double>(genomes_seen_.size())}};
}

void RandomSearch::Save(CanonicalEncoder& encoder) const {
  GAUNTLET_CHECK(AtBoundary(), fmt::format("{} evaluations are outstanding", pending_.size()));
  WriteStateHead(kStateFormat, setup_, encoder);
  encoder.Uint(cases_.size());
  for (const Individual& one : cases_) {
    encoder.Bool(!one.evaluations.empty());
    encoder.Double(one.evaluations.empty() ? 0.0 : one.evaluations.front());
  }
}

Status RandomSearch::Restore(CanonicalDecoder& decoder) {
  Status head = ReadStateHead(kStateFormat, setup_, decoder);
  if (!head.ok()) return head;
  const std::uint64_t count = decoder.Uint();
  if (decoder.ok() && count > Planned()) {
    return InvalidInput(
        fmt::format("the saved search state has {} cases, but the experiment ends at search.cases = {}",
                    count, Planned()));
  }
  std::vector<EvaluationOutcome> outcomes;
  for (IndividualId id = 1; id <= count && decoder.ok(); ++id) {
    EvaluationOutcome outcome;
    outcome.individual = id;
    outcome.completed = decoder.Bool();
    outcome.fitness = decoder.Double();
    outcomes.push_back(outcome);
  }
  if (!decoder.ok()) return Error{ErrorKind::kCorrupt, "the saved search state is damaged: it is cut off"};

  cases_.clear();
  genomes_seen_.clear();
  for (const EvaluationOutcome& outcome : outcomes) {
    cases_.push_back(DrawCase(outcome.individual));
    genomes_seen_.insert(GenomeHash(cases_.back().test_case.obstacles));
    RecordOutcome(outcome, setup_.experiment.search.aggregation, cases_.back());
  }
  evaluations_done_ = count;
  newborns_.clear();
  pending_ = {};
  return Ok{};
}

}  // namespace gauntlet::master
