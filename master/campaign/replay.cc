#include "master/campaign/replay.h"

#include <fmt/format.h>

#include <algorithm>

#include "master/campaign/stored_check.h"
#include "master/campaign/verdict_text.h"
#include "master/dispatch/pool/worker_program.h"
#include "master/store/run_numbers.h"
#include "proto/run_codec.h"
#include "proto/run_text.h"

namespace gauntlet {
namespace {

// What differs between two results of one spec, field by field; empty when the hashes are equal.
std::vector<std::string> DifferencesOf(const sim::RunResult& stored, const sim::RunResult& replayed) {
  std::vector<std::string> differences;
  if (stored.hash == replayed.hash) return differences;
  const auto compare = [&](const std::string& what, const auto& then, const auto& now) {
    if (then != now)
      differences.push_back(fmt::format("{} differs: stored {}, replayed {}", what, then, now));
  };
  const auto hex = [](std::uint64_t hash) { return fmt::format("{:016x}", hash); };
  compare("hash", hex(stored.hash), hex(replayed.hash));
  compare("trajectory hash", hex(stored.trajectory_hash), hex(replayed.trajectory_hash));
  compare("verdict", NameOf(stored.verdict), NameOf(replayed.verdict));
  compare("message", "'" + stored.message + "'", "'" + replayed.message + "'");
  compare("fitness", stored.fitness, replayed.fitness);
  compare("number of ticks", stored.ticks, replayed.ticks);
  compare("failure type", stored.failure.type, replayed.failure.type);
  for (std::size_t i = 0; i < std::min(stored.metrics.size(), replayed.metrics.size()); ++i)
    compare("metric " + stored.metrics[i].first, stored.metrics[i].second, replayed.metrics[i].second);
  for (std::size_t i = 0; i < std::min(stored.robots.size(), replayed.robots.size()); ++i) {
    const sim::Vec2& then = stored.robots[i].start.position;
    const sim::Vec2& now = replayed.robots[i].start.position;
    compare(fmt::format("start of robot {} (x)", i), then.x(), now.x());
    compare(fmt::format("start of robot {} (y)", i), then.y(), now.y());
  }
  return differences;
}

}  // namespace

Result<ReplayReport> ReplayRun(ResultStore& store, RunId run, const std::string& scratch) {
  TRY(std::optional<StoredRun> loaded, store.LoadRun(run));
  if (!loaded.has_value())
    return Error{ErrorKind::kNotFound,
                 fmt::format("there is no run {} in this campaign", proto::RunText(run))};
  return ReplayRun(std::move(*loaded), scratch);
}

Result<ReplayReport> ReplayRun(StoredRun stored, const std::string& scratch) {
  ReplayReport report;
  report.stored = std::move(stored);
  const RunId run = report.stored.id;
  Result<sim::RunSpec> spec = proto::DecodeRunSpec(report.stored.spec);
  if (!spec) {
    report.damage =
        fmt::format("the stored spec of run {} is damaged: {}", proto::RunText(run), spec.error().message);
    return report;
  }
  report.spec = std::move(*spec);
  Result<sim::RunResult> stored_result = proto::DecodeStoredResult(report.stored.result);
  if (!stored_result) {
    report.damage = fmt::format("the stored result of run {} is damaged: {}", proto::RunText(run),
                                stored_result.error().message);
    return report;
  }
  report.stored_result = std::move(*stored_result);
  TRY(CheckCopies(report.stored, report.stored_result));

  sim::RunSpec recorded = report.spec;
  recorded.record_trajectory = true;
  TRY(report.replayed, SimulateInRunner(recorded, scratch));

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

}  // namespace gauntlet
