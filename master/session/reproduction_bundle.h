// What is needed to see a run fail again, anywhere: left in the campaign's directory for every run that
// crashed, hung, ran out of memory or was killed in all its attempts.
#pragma once

#include <string>

#include "base/result.h"
#include "master/dispatch/dispatch_options.h"
#include "master/dispatch/evaluation_backend.h"
#include "master/store/result_store.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

// Whether runs with this verdict leave a bundle.
bool LeavesBundle(sim::Verdict verdict);

// "bundles/run-17", in the campaign's directory.
std::string BundleName(RunId run);
// What the run's bundle says that the last attempt printed last, "uncaught exception: ..."; "" when nothing.
std::string LastWords(const std::string& directory, RunId run);

struct BundleContext {
  std::string directory;  // of the campaign
  CampaignIdentity campaign;
  DispatchOptions limits;  // that its runs had
};

// Writes bundles/run-N: README.txt (what failed, where, by which signal, the one command that reproduces it),
// run.spec (the serialized gauntlet.v1.RunSpec), case.json, experiment.toml, stderr.txt. `run` still has its
// spec. A bundle that is there already is replaced. Error: kIo, kNoSpace.
Status WriteBundle(const BundleContext& context, const Experiment& experiment, const StoredRun& run,
                   const FinishedRun& finished);

}  // namespace gauntlet
