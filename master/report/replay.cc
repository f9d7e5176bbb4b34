#include "master/report/replay.h"

#include <fmt/format.h>

#include <algorithm>

#include "master/dispatch/worker_program.h"
#include "master/report/stored_check.h"
#include "master/report/verdict_text.h"
#include "master/store/run_numbers.h"
#include "proto/run_codec.h"

namespace gauntlet::master {
namespace {

void Compare(const char* name, double stored, double replayed, std::vector<std::string>& differences) {
  if (stored != replayed)
    differences.push_back(fmt::format("{} differs: stored {}, replayed {}", name, stored, replayed));
}

void CompareHash(const char* name, std::uint64_t stored, std::uint64_t replayed,
                 std::vector<std::string>& differences) {
  if (stored != replayed) {
    differences.push_back(
        fmt::format("{} differs: stored {:016x}, replayed {:016x}", name, stored, replayed));
  }
}

}  // namespace

std::vector<std::string> DifferencesOf(const sim::RunResult& stored, const sim::RunResult& replayed) {
  std::vector<std::string> differences;
  if (stored.hash == replayed.hash) return differences;
  CompareHash("hash", stored.hash, replayed.hash, differences);
  CompareHash("trajectory hash", stored.trajectory_hash, replayed.trajectory_hash, differences);
  if (stored.verdict != replayed.verdict) {
    differences.push_back(fmt::format("verdict differs: stored {}, replayed {}", NameOf(stored.verdict),
                                      NameOf(replayed.verdict)));
  }
  if (stored.message != replayed.message) {
    differences.push_back(
        fmt::format("message differs: stored '{}', replayed '{}'", stored.message, replayed.message));
  }
  Compare("fitness", stored.fitness, replayed.fitness, differences);
  Compare("number of ticks", stored.ticks, replayed.ticks, differences);
  Compare("failure type", stored.failure.type, replayed.failure.type, differences);
  for (std::size_t i = 0; i < std::min(stored.metrics.size(), replayed.metrics.size()); ++i) {
    Compare(fmt::format("metric {}", stored.metrics[i].first).c_str(), stored.metrics[i].second,
            replayed.metrics[i].second, differences);
  }
  for (std::size_t i = 0; i < std::min(stored.robots.size(), replayed.robots.size()); ++i) {
    const std::string name = fmt::format("start of robot {}", i);
    Compare((name + " (x)").c_str(), stored.robots[i].start.position.x(),
            replayed.robots[i].start.position.x(), differences);
    Compare((name + " (y)").c_str(), stored.robots[i].start.position.y(),
            replayed.robots[i].start.position.y(), differences);
  }
  return differences;
}

Result<ReplayReport> ReplayRun(ResultStore& store, RunId run) {
  Result<std::optional<StoredRun>> loaded = store.LoadRun(run);
  if (!loaded) return loaded.error();
  if (!loaded->has_value())
    return Error{ErrorKind::kNotFound, fmt::format("there is no run {} in this campaign", run)};
  ReplayReport report;
  report.stored = std::move(**loaded);
  Result<sim::RunSpec> spec = proto::DecodeRunSpec(report.stored.spec);
  if (!spec) {
    report.damage = fmt::format("the stored spec of run {} is damaged: {}", run, spec.error().message);
    return report;
  }
  report.spec = std::move(*spec);
  Result<sim::RunResult> stored_result = proto::DecodeRunResult(report.stored.result);
  if (!stored_result) {
    report.damage =
        fmt::format("the stored result of run {} is damaged: {}", run, stored_result.error().message);
    return report;
  }
  report.stored_result = std::move(*stored_result);
  if (Status same = CheckCopies(report.stored, report.stored_result); !same) return same.error();

  sim::RunSpec recorded = report.spec;
  recorded.record_trajectory = true;
  Result<sim::RunResult> replayed = SimulateInRunner(recorded);
  if (!replayed) return replayed.error();
  report.replayed = std::move(*replayed);

  if (const std::uint64_t hash = SpecHash(report.stored.spec); hash != report.stored.spec_hash) {
    report.differences.push_back(
        fmt::format("the stored spec was changed: its hash differs, {:016x} when it was stored, {:016x} now",
                    report.stored.spec_hash, hash));
  }
  if (report.spec.seed != report.stored.seed) {
    report.differences.push_back(
        fmt::format("seed differs: the run was made with {}, its stored spec says {}", report.stored.seed,
                    report.spec.seed));
  }
  if (report.stored_result.hash != report.stored.hash) {
    report.differences.push_back(
        fmt::format("stored hash differs: {:016x} in the run's row, {:016x} in its result",
                    report.stored.hash, report.stored_result.hash));
  }
  for (std::string& difference : DifferencesOf(report.stored_result, report.replayed))
    report.differences.push_back(std::move(difference));
  return report;
}

}  // namespace gauntlet::master
