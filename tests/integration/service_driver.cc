#include "tests/integration/service_driver.h"

#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace gauntlet::testing_support {

using nlohmann::json;

bool Serves(const std::string& dir) {
  return Eventually([&] { return std::filesystem::exists(dir + "/access.json"); }, kPatience);
}

std::vector<std::string> MasterArguments(const SmallCampaign& campaign, const std::string& dir,
                                         const std::string& endpoint) {
  std::vector<std::string> arguments = CampaignArguments("master", campaign, dir);
  arguments.insert(arguments.end(), {"--bind", endpoint, "--no-progress"});
  return arguments;
}

std::vector<std::string> Insecure(std::vector<std::string> arguments) {
  arguments.emplace_back("--insecure");
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

bool WorkersBusy(const std::string& dir, int workers) {
  return StatusBecomes(dir, [workers](const json& status) {
    const json& list = status.at("worker_list");
    return std::count_if(list.begin(), list.end(),
                         [](const json& worker) { return !worker.at("runs").empty(); }) >= workers;
  });
}

bool LogBecomes(const std::string& dir, const std::string& text) {
  return Eventually([&] { return MasterLog(dir).find(text) != std::string::npos; }, kPatience);
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
