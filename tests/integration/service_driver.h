// Masters whose workers come from elsewhere, as the drills start, watch and read them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {

// Whether the campaign's master listens before too long.
bool Serves(const std::string& dir);

std::vector<std::string> MasterArguments(const SmallCampaign& campaign, const std::string& dir,
                                         const std::string& endpoint = "tcp://127.0.0.1:*");
// The same in plaintext, open to everybody.
std::vector<std::string> Insecure(std::vector<std::string> arguments);
std::vector<std::string> ResumeArguments(const std::string& dir,
                                         const std::string& endpoint = "tcp://127.0.0.1:*");

std::unique_ptr<Process> StartWorker(const std::string& dir, const std::string& orphan_timeout = "60");
// gauntlet-worker-slow: every run takes `milliseconds` longer and no more CPU time. `run_log`, when given:
// every run appends its seed to this file when it begins.
std::unique_ptr<Process> StartSlowWorker(const std::string& dir, int milliseconds,
                                         const std::string& run_log = "");

// `status DIR --json`; null when it does not answer.
nlohmann::json StatusOf(const std::string& dir);
bool StatusBecomes(const std::string& dir, const std::function<bool(const nlohmann::json&)>& condition);
bool RunsDone(const std::string& dir, int runs);
// So many workers have runs at the same time.
bool WorkersBusy(const std::string& dir, int workers);

// What log/master.log says so far.
std::string MasterLog(const std::string& dir);
bool LogBecomes(const std::string& dir, const std::string& text);

// The signal goes to the process and everything below it.
void SignalFamily(const Process& process, int signal);

// Resident memory of a process, MiB; 0 when there is none.
double ResidentMebibytes(pid_t pid);

}  // namespace gauntlet::testing_support
