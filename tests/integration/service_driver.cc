#include "tests/integration/service_driver.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <map>

namespace gauntlet::testing_support {

using nlohmann::json;

bool Serves(const std::string& dir) {
  return Eventually([&] { return std::filesystem::exists(dir + "/access.json"); }, kPatience);
}

std::vector<std::string> MasterArguments(const SmallCampaign& campaign, const std::string& dir,
                                         const std::string& endpoint) {
  std::vector<std::string> arguments = {"master",        campaign.experiment,
                                        "--dir",         dir,
                                        "--bind",        endpoint,
                                        "--seed",        campaign.seed,
                                        "--population",  std::to_string(campaign.population),
                                        "--generations", std::to_string(campaign.generations),
                                        "--no-progress"};
  for (const std::string& setting : campaign.settings) arguments.insert(arguments.end(), {"--set", setting});
  return arguments;
}

std::vector<std::string> ResumeArguments(const std::string& dir, const std::string& endpoint) {
  return {"resume", dir, "--bind", endpoint, "--no-progress"};
}

std::unique_ptr<Process> StartWorker(const std::string& dir, const std::string& orphan_timeout) {
  return std::make_unique<Process>(
      std::vector<std::string>{WorkerPath(), "--dir", dir, "--orphan-timeout", orphan_timeout});
}

std::unique_ptr<Process> StartSlowWorker(const std::string& dir, int milliseconds,
                                         const std::string& run_log) {
  return std::make_unique<Process>(
      std::vector<std::string>{WorkerPath() + "-slow", "--dir", dir, "--orphan-timeout", "60"},
      std::vector<std::string>{"GAUNTLET_TEST_RUN_MILLISECONDS=" + std::to_string(milliseconds),
                               "GAUNTLET_TEST_RUN_LOG=" + run_log});
}

json StatusOf(const std::string& dir) {
  const ProcessResult result = Gauntlet({"status", dir, "--json"});
  return result.exit_code == 0 ? json::parse(result.out, nullptr, false) : json();
}

bool StatusBecomes(const std::string& dir, const std::function<bool(const json&)>& condition) {
  return Eventually(
      [&] {
        const json status = StatusOf(dir);
        return status.is_object() && condition(status);
      },
      kPatience);
}

bool RunsDone(const std::string& dir, int runs) {
  return StatusBecomes(dir, [runs](const json& status) { return status.value("runs_done", 0) >= runs; });
}

std::string MasterLog(const std::string& dir) {
  return ReadFile(dir + "/log/master.log");
}

bool LogBecomes(const std::string& dir, const std::string& text) {
  return Eventually([&] { return MasterLog(dir).find(text) != std::string::npos; }, kPatience);
}

std::vector<std::uint64_t> StoredRuns(const std::string& dir) {
  std::vector<std::uint64_t> runs;
  sqlite3* database = nullptr;
  if (sqlite3_open_v2(("file:" + dir + "/campaign.db?immutable=1").c_str(), &database,
                      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr) == SQLITE_OK) {
    sqlite3_stmt* query = nullptr;
    sqlite3_prepare_v2(database, "SELECT id FROM runs ORDER BY id", -1, &query, nullptr);
    while (sqlite3_step(query) == SQLITE_ROW) {
      runs.push_back(static_cast<std::uint64_t>(sqlite3_column_int64(query, 0)));
    }
    sqlite3_finalize(query);
  }
  sqlite3_close(database);
  return runs;
}

const std::string& UndisturbedHash(const SmallCampaign& campaign) {
  static std::map<std::vector<std::string>, std::string> hashes;
  std::string& hash = hashes[EvolveArguments(campaign, "", 2)];
  if (hash.empty()) {
    const TemporaryDirectory scratch;
    const ProcessResult result = Gauntlet(EvolveArguments(campaign, scratch / "c", 2));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    hash = StateHash(scratch / "c");
    EXPECT_EQ(hash.size(), 64u);
  }
  return hash;
}

void SignalFamily(const Process& process, int signal) {
  for (const pid_t pid : DescendantsOf(process.pid())) kill(pid, signal);
  process.Signal(signal);
}

double ResidentMebibytes(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.rfind("VmRSS:", 0) == 0) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0.0;
}

}  // namespace gauntlet::testing_support
