#include "search/given/case_blame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/check.h"
#include "search/given/given_search.h"

namespace gauntlet {
namespace {

// Of more obstacles than these only the pairs of those that robots visited most are tried.
constexpr std::size_t kMostPaired = 8;

const std::vector<controllers::ParameterInfo> kBlameParameters = {
    {"part_runs", "", 30, 2, 10000, true, "runs of the case, and of it without each obstacle"}};

std::unique_ptr<LayoutQuestion> AskForBlame(const Experiment& experiment, const sim::Genome& obstacles) {
  return std::make_unique<CaseBlame>(obstacles, BlameReplicates(experiment));
}

}  // namespace

bool ClearlyLess(const FailureTally& without, const FailureTally& whole) {
  if (without.runs() == 0 || whole.runs() == 0) return false;
  if (without.mostly_refused() || whole.mostly_refused()) return false;
  const double n1 = whole.runs();
  const double n2 = without.runs();
  const double difference = whole.failures / n1 - without.failures / n2;
  const double pooled = (whole.failures + without.failures) / (n1 + n2);
  constexpr double kStandardErrors = 3.0;
  return difference > 0.0 && difference * difference > kStandardErrors * kStandardErrors * pooled *
                                                           (1.0 - pooled) * (1.0 / n1 + 1.0 / n2);
}

CaseBlame::CaseBlame(sim::Genome obstacles, int replicates)
    : all_(AllOf(obstacles)), replicates_(replicates), wanted_{{}} {
  for (const std::size_t obstacle : all_.kept) wanted_.push_back({obstacle});
  Prepare();
}

void CaseBlame::Prepare() {
  layout_ = all_;
  if (next_ == wanted_.size()) return;
  for (const std::size_t obstacle : wanted_[next_]) layout_ = Without(layout_, obstacle);
}

void CaseBlame::Tell(const LayoutRuns& runs) {
  GAUNTLET_CHECK(next_ < wanted_.size(), "nothing was asked for");
  parts_.push_back({wanted_[next_++], runs});
  const FailureTally& whole = parts_.front().runs.tally;
  if (whole.failures == 0) wanted_.resize(next_);  // nothing to blame
  if (next_ == wanted_.size() && next_ == all_.kept.size() + 1) WantPairs();
  Prepare();
}

void CaseBlame::WantPairs() {
  const FailureTally& whole = parts_.front().runs.tally;
  if (std::ranges::any_of(parts_, [&](const Part& part) { return ClearlyLess(part.runs.tally, whole); }))
    return;
  std::vector<std::size_t> candidates = all_.kept;
  const std::vector<std::uint64_t>& visits = parts_.front().runs.visits;
  if (candidates.size() > kMostPaired && visits.size() == candidates.size()) {
    std::ranges::stable_sort(candidates, std::greater{}, [&](std::size_t one) { return visits[one]; });
  }
  candidates.resize(std::min(candidates.size(), kMostPaired));
  std::ranges::sort(candidates);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (std::size_t j = i + 1; j < candidates.size(); ++j) wanted_.push_back({candidates[i], candidates[j]});
  }
}

int BlameReplicates(const Experiment& experiment) {
  return static_cast<int>(ValueOf(kBlameParameters[0], experiment.search.parameters));
}

Experiment BlameExperiment(const Experiment& experiment, int replicates) {
  Experiment blame = AboutCasesOf(experiment, "blame");
  blame.search.parameters[std::string(kBlameParameters[0].name)] = replicates;
  return blame;
}

SearchRow BlameRow() {
  return {.info = {.name = "blame",
                   .description = "what each obstacle of given cases contributes to failures: gauntlet blame",
                   .parameters = kBlameParameters},
          .number = 6,
          .title = "blame of obstacles",
          .plan = [](const Experiment& e) { return fmt::format("{} runs of each part", BlameReplicates(e)); },
          .make = Make<GivenSearch>,
          .purpose = sim::SeedPurpose::kBlame,
          .question = AskForBlame,
          .reads_trajectories = true,
          .command = "blame",
          .seeds_of_cases = true};
}

}  // namespace gauntlet
