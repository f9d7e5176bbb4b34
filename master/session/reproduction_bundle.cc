#include "master/session/reproduction_bundle.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "base/split.h"
#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "master/campaign/verdict_text.h"
#include "proto/case_json.h"
#include "proto/run_codec.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr const char* kPrinted = "stderr.txt";  // in a bundle

}  // namespace

bool LeavesBundle(sim::Verdict verdict) {
  return verdict == sim::Verdict::kCrashed || verdict == sim::Verdict::kHung ||
         verdict == sim::Verdict::kOutOfMemory || verdict == sim::Verdict::kKilled;
}

std::string LastWords(const std::string& directory, RunId run) {
  const Result<std::string> printed =
      ReadRegularFile(fmt::format("{}/{}/{}", directory, BundleName(run), kPrinted));
  return printed ? Split(Trimmed(*printed), '\n').back() : "";
}

std::string BundleName(RunId run) {
  return fmt::format("bundles/run-{}", run);
}

Status WriteBundle(const BundleContext& context, const Experiment& experiment, const StoredRun& run,
                   const FinishedRun& finished) {
  const std::filesystem::path folder = std::filesystem::path(context.directory) / BundleName(run.id);
  for (const std::filesystem::path& part : {folder.parent_path(), folder}) {
    TRY(MakeDirectory(part.string()));
  }
  TRY(const sim::RunSpec spec, proto::DecodeRunSpec(run.spec));
  std::string command = fmt::format("gauntlet-worker --run-spec run.spec --cpu-limit {} --memory-limit {}",
                                    context.limits.cpu_limit_seconds, context.limits.memory_limit_bytes);
  for (const std::string& plugin : std::set{spec.plugin, spec.scenario_plugin}) {
    if (plugin.empty()) continue;
    const std::filesystem::path file = PluginFileIn(context.directory + "/plugins", plugin);
    command += fmt::format(" --plugin ../../plugins/{}", file.filename().string());
  }
  const proto::GoldenHashes& known = context.campaign.golden_hashes;
  const auto golden = known.find(spec.controller);
  const std::string readme = fmt::format(
      "Run {} of the campaign {} {} ({}), in every attempt; the last was on worker {}.\n\n"
      "See it again, in this folder:\n    {} > result\n"
      "It says on stderr how the run ends. `result` is a serialized gauntlet.v1.RunResult.\n\n"
      "scenario      {}\ncontroller    {}\nseed          {}\nindividual    {}, evaluation {}, replicate {}\n"
      "version       gauntlet {}\ngolden hash   {:016x}\n\n"
      "run.spec         all the run depends on, as a serialized gauntlet.v1.RunSpec\n"
      "case.json        the test case, for gauntlet evaluate --case\n"
      "experiment.toml  the experiment, every default written out\n"
      "stderr.txt       what the last attempt printed\n",
      run.id, context.campaign.campaign_id, finished.result.message, NameOf(finished.result.verdict),
      finished.worker, command, spec.scenario, spec.controller, run.seed, run.individual, run.evaluation,
      run.replicate, context.campaign.software_version, golden == known.end() ? 0 : golden->second);
  for (const auto& [name, text] : {std::pair<const char*, std::string>("run.spec", run.spec),
                                   {"case.json", proto::WriteCaseJson(spec.test_case)},
                                   {"experiment.toml", WriteExperiment(experiment, {}, BuiltInCatalogue())},
                                   {kPrinted, finished.stderr_tail},
                                   {"README.txt", readme}}) {
    TRY(ReplaceFile((folder / name).string(), text, kReadableByAll));
  }
  return Ok{};
}

}  // namespace gauntlet
