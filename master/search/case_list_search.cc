#include "master/search/case_list_search.h"

#include <fmt/format.h>

#include <set>

#include "base/check.h"
#include "base/hash.h"
#include "sim/arena/genome_codec.h"

namespace gauntlet::master {
namespace {

// Saved states begin with it. Raise it whenever the encoding or the meaning of a state changes.
constexpr std::uint64_t kStateFormat = 1;

}  // namespace

CaseListSearch::CaseListSearch(std::vector<sim::TestCase> cases, int replicates) : replicates_(replicates) {
  GAUNTLET_CHECK(replicates >= 1, fmt::format("{} replicates", replicates));
  for (sim::TestCase& test_case : cases) {
    cases_.push_back(MakeIndividual(cases_.size() + 1, std::move(test_case)));
  }
}

std::vector<EvaluationRequest> CaseListSearch::Ask() {
  if (asked_) return {};
  asked_ = true;
  newborns_ = cases_;
  std::vector<EvaluationRequest> requests;
  for (const Individual& one : cases_) {
    requests.push_back(NextEvaluation(one, replicates_, 1));
    pending_.Add(requests.back());
  }
  return requests;
}

void CaseListSearch::Tell(const EvaluationOutcome& outcome) {
  pending_.Settle(outcome);
  RecordOutcome(outcome, FitnessAggregation::kMean, cases_[outcome.individual - 1]);
  ++evaluations_done_;
}

SearchProgress CaseListSearch::Progress() const {
  return {.generation = asked_ ? 1U : 0U,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = cases_.size(),
          .finished = evaluations_done_ >= cases_.size()};
}

std::vector<std::pair<std::string, double>> CaseListSearch::Statistics() const {
  std::set<std::uint64_t> genomes;
  for (const Individual& one : cases_) genomes.insert(GenomeHash(one.test_case.obstacles));
  return {{"distinct_individuals", static_cast<double>(genomes.size())}};
}

std::uint64_t CaseListSearch::ListHash() const {
  Fnv1a64 hash;
  hash.AddUint64(static_cast<std::uint64_t>(replicates_));
  for (const Individual& one : cases_) {
    const sim::TestCase& test_case = one.test_case;
    hash.AddUint64(GenomeHash(test_case.obstacles));
    hash.AddDouble(test_case.side_x);
    hash.AddDouble(test_case.side_y);
    hash.AddDouble(test_case.wall_thickness);
    hash.AddUint64(static_cast<std::uint64_t>(test_case.robots.value_or(-1)));
    if (!test_case.spawn_area.has_value()) continue;
    for (const sim::Vec2& corner : {test_case.spawn_area->min, test_case.spawn_area->max}) {
      hash.AddDouble(corner.x());
      hash.AddDouble(corner.y());
    }
  }
  return hash.value();
}

void CaseListSearch::Save(CanonicalEncoder& encoder) const {
  GAUNTLET_CHECK(AtBoundary(), fmt::format("{} evaluations are outstanding", pending_.size()));
  encoder.Uint(kStateFormat);
  encoder.Uint(ListHash());
  encoder.Bool(asked_);
  for (const Individual& one : cases_) {
    encoder.Bool(!one.evaluations.empty());
    encoder.Double(one.evaluations.empty() ? 0.0 : one.evaluations.front());
  }
}

Status CaseListSearch::Restore(CanonicalDecoder& decoder) {
  const std::uint64_t format = decoder.Uint();
  if (decoder.ok() && format != kStateFormat) {
    return Error{
        ErrorKind::kVersion,
        fmt::format("the saved search state has format {}, this version reads {}", format, kStateFormat)};
  }
  const std::uint64_t list_hash = decoder.Uint();
  if (decoder.ok() && list_hash != ListHash()) {
    return InvalidInput("the saved search state belongs to another list of cases or number of replicates");
  }
  const bool asked = decoder.Bool();
  std::vector<EvaluationOutcome> outcomes;
  for (const Individual& one : cases_) {
    EvaluationOutcome outcome;
    outcome.individual = one.id;
    outcome.completed = decoder.Bool();
    outcome.fitness = decoder.Double();
    outcomes.push_back(outcome);
  }
  if (!decoder.ok()) return Error{ErrorKind::kCorrupt, "the saved search state is damaged: it is cut off"};

  for (Individual& one : cases_) one = MakeIndividual(one.id, std::move(one.test_case));
  asked_ = asked;
  evaluations_done_ = 0;
  newborns_.clear();
  pending_ = {};
  if (!asked) return Ok{};
  for (const EvaluationOutcome& outcome : outcomes) {
    RecordOutcome(outcome, FitnessAggregation::kMean, cases_[outcome.individual - 1]);
    ++evaluations_done_;
  }
  return Ok{};
}

}  // namespace gauntlet::master
