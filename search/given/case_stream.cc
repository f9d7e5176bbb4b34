#include "search/given/case_stream.h"

#include <utility>

#include "search/given/repeated_case.h"

namespace gauntlet {

Result<std::unique_ptr<CaseStream>> CaseStream::Create(SearchSetup setup) {
  return std::unique_ptr<CaseStream>(new CaseStream(std::move(setup)));
}

IndividualId CaseStream::Add(StreamedCase one) {
  const IndividualId id = evaluations_done_ + open_.size() + 1;
  Individual individual = MakeIndividual(id, std::exchange(one.test_case, {}));
  open_.push_back({std::move(individual), std::move(one)});
  return id;
}

std::vector<EvaluationRequest> CaseStream::Ask() {
  std::vector<EvaluationRequest> requests;
  for (; asked_ < open_.size(); ++asked_) {
    const Open& one = open_[asked_];
    EvaluationRequest& request = requests.emplace_back(Request(one.individual, 1));
    request.settings = one.asked.settings;
    request.seed = one.asked.seed;
    request.replicates = one.asked.replicates;
  }
  return requests;
}

void CaseStream::Told(const EvaluationOutcome& /*outcome*/) {
  open_.pop_front();
  --asked_;
}

SearchProgress CaseStream::Progress() const {
  const std::uint64_t known = evaluations_done_ + open_.size();
  return {.generation = known > 0 ? 1U : 0U,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = known,
          .individuals_planned = known,
          .finished = ended_ && open_.empty()};
}

bool CaseStream::AtBoundary() const {
  return evaluations_done_ % kSaveInterval == 0 || Progress().finished;
}

Status CaseStream::RestoreRest(CanonicalDecoder& /*decoder*/, const History& history) {
  if (setup_.cases.empty()) return Ok{};  // its master needs none that is told
  return Recall(history, [this](const EvaluationOutcome& outcome) {
    const std::size_t place = outcome.individual - 1;
    if (place >= setup_.cases.size()) return;
    Individual& one =
        population_.emplace_back(MakeIndividual(outcome.individual, std::move(setup_.cases[place])));
    Record(outcome, one);
  });
}

SearchRow StreamRow() {
  SearchRow row = CaseListRow();
  row.info.name = "stream";
  row.info.description = "test cases that arrive one after the other: gauntlet evaluate --stdin";
  row.number = 12;
  row.title = "a stream of cases";
  row.make = Make<CaseStream>;
  row.question = nullptr;
  row.varies_settings = true;
  row.streamed = true;
  return row;
}

}  // namespace gauntlet
