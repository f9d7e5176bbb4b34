#include "master/campaign/forecast.h"

#include <algorithm>
#include <memory>
#include <set>
#include <string>

#include "master/campaign/observed_reproducibility.h"
#include "master/store/packing.h"
#include "master/store/run_numbers.h"
#include "proto/run_codec.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::uint64_t kMostMeasured = 12;
// CPU time after which no more runs are measured; two are needed for the size, as the first serves as the
// example with which the others are packed.
constexpr double kEnoughSeconds = 5.0;
constexpr std::uint64_t kLeastMeasured = 2;

// What a campaign takes beside packed specs and results, by the databases of 300 to 5,000 runs of flocking,
// foraging and task partitioning, which agree with it within 15 %.
constexpr double kBytesOfACampaign = 100e3;  // empty tables, texts, logs
constexpr double kBytesOfARow = 330;         // of a run, with its share of the saved states
constexpr double kBytesOfACase = 240;

// The sizes of specs and results as the store packs them.
class PackedSize {
 public:
  void Add(const sim::RunSpec& spec, const sim::RunResult& result, bool trajectories) {
    if (result.verdict != sim::Verdict::kCompleted) return;
    Add(specs_, proto::EncodeRunSpec(spec));
    Add(results_, trajectories ? proto::EncodeRunResult(result, proto::TrajectoryEncoding::kLeaveOut)
                               : proto::EncodeWithoutWays(result));
    ++runs_;
  }
  // Of the runs behind the example; of the example itself when there are no others.
  double Mean() const {
    if (runs_ == 0) return 0.0;
    return runs_ == 1 ? example_bytes_ : packed_bytes_ / static_cast<double>(runs_ - 1);
  }

 private:
  void Add(Packing& packing, const std::string& bytes) {
    if (packing.learned()) {
      packed_bytes_ += static_cast<double>(packing.Pack(bytes).size());
    } else {
      example_bytes_ += static_cast<double>(packing.Pack(bytes).size());
      packing.Learn(bytes);
    }
  }

  Packing specs_;
  Packing results_;
  double example_bytes_ = 0.0;
  double packed_bytes_ = 0.0;
  std::uint64_t runs_ = 0;
};

// The runs that a search asks for first.
std::vector<sim::RunSpec> FirstRuns(const Experiment& experiment, SearchAlgorithm& search,
                                    std::uint64_t number) {
  std::vector<sim::RunSpec> runs;
  for (const EvaluationRequest& request : search.Ask()) {
    for (std::uint32_t i = 0; i < request.replicates && runs.size() < number; ++i) {
      runs.push_back(SpecOfRun(experiment, request, i));
    }
  }
  return runs;
}

// No search breeds, and none has the cases of another.
bool AllCasesDiffer(const std::vector<SearchPlan>& plans) {
  std::set<std::uint64_t> seeds;
  return std::ranges::all_of(plans, [&](const SearchPlan& plan) {
    return !RowOf(plan.experiment).Related() && seeds.insert(plan.experiment.seed).second;
  });
}

}  // namespace

Result<Forecast> MakeForecast(const std::vector<SearchPlan>& plans,
                              const std::function<Result<sim::RunResult>(const sim::RunSpec&)>& simulate) {
  Forecast forecast;
  forecast.cases_exact = AllCasesDiffer(plans);
  // Of searches at even distances: their runs may take differently long.
  const std::uint64_t sampled = std::min<std::uint64_t>(plans.size(), kMostMeasured);
  const std::uint64_t runs_each = kMostMeasured / sampled;
  std::vector<std::vector<sim::RunSpec>> first_runs;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const Experiment& experiment = plans[i].experiment;
    TRY(const std::unique_ptr<SearchAlgorithm> search, MakeSearch(experiment, plans[i].cases));
    const SearchProgress planned = search->Progress();
    forecast.runs += planned.evaluations_planned * static_cast<std::uint64_t>(experiment.search.replicates);
    forecast.cases += planned.individuals_planned;
    if (first_runs.size() < sampled && i == first_runs.size() * plans.size() / sampled)
      first_runs.push_back(FirstRuns(experiment, *search, runs_each));
  }

  PackedSize size;
  double seconds = 0.0;
  for (std::uint64_t i = 0; i < runs_each; ++i) {
    for (std::size_t search = 0; search < first_runs.size(); ++search) {
      const std::vector<sim::RunSpec>& runs = first_runs[search];
      if (i >= runs.size() || (seconds > kEnoughSeconds && forecast.measured_runs >= kLeastMeasured))
        continue;
      TRY(const sim::RunResult result, simulate(runs[i]));
      seconds += result.cpu_seconds;
      ++forecast.measured_runs;
      if (result.verdict != sim::Verdict::kCompleted) {
        ++forecast.measured_without_result;
        forecast.why_without_result = result.message;
      }
      size.Add(runs[i], result, KeepsWays(plans[search * plans.size() / sampled].experiment));
    }
  }
  forecast.seconds_per_run = seconds / static_cast<double>(forecast.measured_runs);
  forecast.bytes = kBytesOfACampaign + static_cast<double>(forecast.runs) * (size.Mean() + kBytesOfARow) +
                   static_cast<double>(forecast.cases) * kBytesOfACase;
  return forecast;
}

}  // namespace gauntlet
