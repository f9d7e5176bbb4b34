#include "tests/slurm/cluster/slurm_cluster.h"

#include <cstdlib>
#include <sstream>

#include "base/check.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using std::chrono::seconds;

constexpr const char* kScript = GAUNTLET_SOURCE_DIR "/tests/slurm/slurm-cluster";
constexpr seconds kInstallTime{300};
constexpr seconds kStartTime{300};  // 1 to 3 s on a machine that has nothing else to do

}  // namespace

std::string SlurmCluster::WhyMissing() {
  const TemporaryDirectory directory;
  const ProcessResult result = RunProcess({kScript, "install", "--dir", directory.path()}, {}, kInstallTime);
  return result.exit_code == 0 ? "" : result.err;
}

SlurmCluster::SlurmCluster(const std::vector<std::string>& options) {
  // Outlives this process when it is killed, sees its pipe end, and stops the cluster.
  const std::string guardian = std::string("setsid --fork sh -c 'read line; exec ") + kScript +
                               " stop --dir " + directory_.path() + "' >/dev/null 2>&1";
  guardian_ = popen(guardian.c_str(), "we");
  std::vector<std::string> arguments = {"start"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  arguments.insert(arguments.end(), {"--wait", "200"});
  const ProcessResult result = Script(arguments);
  GAUNTLET_CHECK(result.exit_code == 0, "slurm-cluster does not start: " + result.err);
  setenv("SLURM_CONF", (directory_.path() + "/slurm.conf").c_str(), 1);
}

SlurmCluster::~SlurmCluster() {
  Script({"stop"});
  if (guardian_ != nullptr) pclose(guardian_);
}

ProcessResult SlurmCluster::Script(const std::vector<std::string>& arguments) const {
  std::vector<std::string> command = {kScript};
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.insert(command.end(), {"--dir", directory_.path()});
  return RunProcess(command, {}, kStartTime);
}

void SlurmCluster::Do(const std::vector<std::string>& command) const {
  const ProcessResult result = Script(command);
  EXPECT_EQ(result.exit_code, 0) << command.front() << ": " << result.err;
}

std::string Slurm(const std::vector<std::string>& command) {
  std::vector<std::string> arguments = {"/usr/bin/env"};
  arguments.insert(arguments.end(), command.begin(), command.end());
  const ProcessResult result = RunProcess(arguments);
  EXPECT_EQ(result.exit_code, 0) << command.front() << ": " << result.err;
  return result.out;
}

std::vector<std::string> QueueLines(const std::vector<std::string>& options) {
  std::vector<std::string> command = {"squeue", "--noheader", "--array", "--format=%i %T %j"};
  command.insert(command.end(), options.begin(), options.end());
  std::istringstream text(Slurm(command));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

void SlurmTest::SetUp() {
  static const std::string missing = SlurmCluster::WhyMissing();
  if (!missing.empty()) GTEST_SKIP() << "no Slurm on this machine, and it cannot be installed: " << missing;
}

std::vector<std::string> SlurmTest::SubmitArguments(const SmallCampaign& campaign, const std::string& master,
                                                    const std::vector<std::string>& settings) const {
  std::vector<std::string> arguments = {"submit",
                                        campaign.experiment,
                                        "--dir",
                                        dir(),
                                        "--seed",
                                        campaign.seed,
                                        "--population",
                                        std::to_string(campaign.population),
                                        "--generations",
                                        std::to_string(campaign.generations),
                                        "--master",
                                        master,
                                        "--no-progress",
                                        "--slurm",
                                        "bind=tcp://127.0.0.1:*"};
  for (const std::string& setting : campaign.settings) arguments.insert(arguments.end(), {"--set", setting});
  for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--slurm", setting});
  return arguments;
}

std::string SlurmTest::SlowWorkers(int milliseconds) {
  return "worker_command=env GAUNTLET_TEST_RUN_MILLISECONDS=" + std::to_string(milliseconds) + " " +
         GAUNTLET_BINARY_DIR + "/gauntlet-worker-slow";
}

std::string SlurmTest::LocalHash(const SmallCampaign& campaign) const {
  const std::string local = scratch_ / "local";
  const ProcessResult result = Gauntlet(EvolveArguments(campaign, local, 2));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return StateHash(local);
}

nlohmann::json SlurmTest::Status() const {
  const ProcessResult result = Gauntlet({"status", dir(), "--json"});
  return result.exit_code == 0 ? nlohmann::json::parse(result.out, nullptr, false) : nlohmann::json();
}

bool SlurmTest::StatusBecomes(const std::function<bool(const nlohmann::json&)>& condition,
                              seconds patience) const {
  nlohmann::json status;
  const bool became = Eventually(
      [&] {
        status = Status();
        return status.is_object() && condition(status);
      },
      patience);
  EXPECT_TRUE(became) << status.dump(2);
  return became;
}

bool SlurmTest::QueueEmpties() {
  return Eventually([] { return QueueLines().empty(); }, seconds(30));
}

}  // namespace gauntlet::testing_support
