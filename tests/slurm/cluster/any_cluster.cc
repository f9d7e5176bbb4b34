#include "tests/slurm/cluster/any_cluster.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "base/check.h"
#include "slurm/slurm_campaign.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using std::chrono::seconds;

constexpr seconds kScriptTime{300};

struct Kind {
  std::string script;
  std::vector<std::string> start;
};

const Kind& KindOf(const std::string& name) {
  static const std::string folder = GAUNTLET_SOURCE_DIR "/tests/slurm/";
  static const std::map<std::string, Kind> kinds = {
      {"sge", {folder + "sge-cluster", {"--nodes", "2", "--slots", "2", "--wait", "200"}}},
      {"pbs", {folder + "pbs_stand_in.py", {"--nodes", "2", "--slots", "2", "--kill-delay", "5"}}},
      {"ssh", {folder + "sshd-hosts", {"--hosts", "alpha beta"}}}};
  return kinds.at(name);
}

}  // namespace

std::string AnyCluster::WhyMissing(const std::string& kind) {
  const TemporaryDirectory directory;
  const std::vector<std::string> command =
      kind == "pbs" ? std::vector<std::string>{KindOf(kind).script, "--help"}
                    : std::vector<std::string>{KindOf(kind).script, "install", "--dir", directory / "c"};
  const ProcessResult result = RunProcess(command, {}, kScriptTime);
  return result.exit_code == 0 ? "" : result.err;
}

AnyCluster::AnyCluster(const std::string& kind) : kind_(kind) {
  // Outlives this process when it is killed, sees its pipe end, and stops the cluster.
  const std::string guardian = std::string("setsid --fork sh -c 'read line; exec ") + KindOf(kind).script +
                               " stop --dir " + directory_ / "c" + "' >/dev/null 2>&1";
  guardian_ = popen(guardian.c_str(), "we");
  std::vector<std::string> arguments = {"start"};
  arguments.insert(arguments.end(), KindOf(kind).start.begin(), KindOf(kind).start.end());
  const ProcessResult result = Script(arguments);
  GAUNTLET_CHECK(result.exit_code == 0, kind + " does not start: " + result.err);
  if (kind == "pbs")
    std::ofstream(file("env")) << "export PATH=" << file("bin")
                               << ":$PATH PBS_STAND_IN_DIR=" << directory_ / "c"
                               << "\n";
  std::istringstream entries(RunProcess({"/bin/bash", "-c", ". '" + file("env") + "'; env -0"}).out);
  for (std::string entry; std::getline(entries, entry, '\0');) {
    const std::string name = entry.substr(0, entry.find('='));
    const char* before = std::getenv(name.c_str());
    environment_before_[name] = before == nullptr ? "" : before;
    setenv(name.c_str(), entry.substr(std::min(entry.size(), name.size() + 1)).c_str(), 1);
  }
}

AnyCluster::~AnyCluster() {
  Script({"stop"});
  for (const auto& [name, value] : environment_before_) setenv(name.c_str(), value.c_str(), 1);
  if (guardian_ != nullptr) pclose(guardian_);
}

ProcessResult AnyCluster::Script(const std::vector<std::string>& arguments) const {
  std::vector<std::string> command = {KindOf(kind_).script};
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.insert(command.end(), {"--dir", directory_ / "c"});
  return RunProcess(command, {}, kScriptTime);
}

void AnyCluster::Do(const std::vector<std::string>& command) const {
  const ProcessResult result = Script(command);
  EXPECT_EQ(result.exit_code, 0) << command.front() << ": " << result.err;
}

// With its own ssh, which jobs have not in their PATH.
std::string AnyCluster::Base() const {
  if (kind_ != "ssh") return "like = \"" + kind_ + "\"\n";
  return "hosts = [\"alpha:2\", \"beta:2\"]\nconnect = '" + file("bin/ssh") +
         " -o BatchMode=yes -o ConnectTimeout=5 -- \"$@\"'\n";
}

std::string AnyCluster::Setting(const std::string& changes) {
  const std::string path = directory_ / "lab.toml";
  std::ofstream(path) << Base() << changes << "\n";
  return "cluster=" + (changes.empty() && kind_ != "ssh" ? kind_ : path);
}

std::unique_ptr<slurm::SlurmClient> AnyCluster::Client() const {
  slurm::SlurmSettings settings;
  settings.cluster = kind_ == "ssh" ? directory_ / "ssh.toml" : kind_;
  if (kind_ == "ssh") std::ofstream(settings.cluster) << Base();
  return slurm::SlurmCampaign::Make(settings, directory_ / "none")->MakeClient();
}

std::vector<slurm::JobStatus> AnyCluster::Jobs() const {
  Result<std::vector<slurm::JobStatus>> jobs = Client()->Queue("");
  if (!jobs) return {{.id = jobs.error().message, .name = "", .state = "", .reason = "", .nodes = ""}};
  std::erase_if(*jobs, [](const slurm::JobStatus& job) { return job.phase == slurm::JobPhase::kEnded; });
  return *jobs;
}

void AnyCluster::Cancel(const std::string& job) const {
  const Status done = Client()->Cancel({job});
  EXPECT_TRUE(done.ok()) << (done ? "" : done.error().message);
}

void AnyCluster::Kill(const std::string& job) {
  const ProcessResult killed =
      RunProcess({"/bin/bash", "-c",
                  "for file in $(grep -lsxzF \"GAUNTLET_BATCH_JOB=$1\" /proc/[0-9]*/environ); do\n"
                  "  pid=${file#/proc/}; session=$(ps -o sess= -p ${pid%/environ}) || continue\n"
                  "  kill -KILL $(ps -o pid= -s $session) && exit 0\n"
                  "done; exit 1",
                  "kill", job});
  EXPECT_EQ(killed.exit_code, 0) << killed.err;
}

void AnyClusterTest::SetUp() {
  static std::map<std::string, std::string> missing;
  const auto [entry, asked] = missing.try_emplace(GetParam());
  if (asked) entry->second = AnyCluster::WhyMissing(GetParam());
  if (!entry->second.empty())
    GTEST_SKIP() << "no " << GetParam() << " on this machine, and it cannot be installed: " << entry->second;
  site_ = std::make_unique<AnyCluster>(GetParam());
}

bool AnyClusterTest::QueueEmpties() const {
  return Eventually([&] { return site_->Jobs().empty(); }, seconds(60));
}

}  // namespace gauntlet::testing_support
