// A Slurm cluster in memory.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "slurm/slurm_client.h"

namespace gauntlet::testing_support {

// What a cluster was asked, and how it answers. Tests read and write the members; where a pool's thread
// shares them, while it has nothing to do.
class FakeSlurm {
 public:
  std::vector<slurm::JobStatus> jobs;
  std::vector<std::string> tested;                // scripts
  std::vector<std::string> submitted;             // scripts
  std::vector<std::vector<std::string>> options;  // of the submissions
  std::vector<std::string> cancelled;             // job ids
  int queries = 0;

  int next_id = 1;
  std::string refusal;   // of the next submissions and tests; "" = accepted
  std::string hopeless;  // likewise, for ever
  std::string full;      // likewise, for want of room
  std::string id_prefix;
  bool loses_answers = false;    // accepts, but the answer does not arrive
  bool deaf = false;             // cancellations do not arrive
  std::string controller_error;  // of queries

  std::unique_ptr<slurm::SlurmClient> MakeClient() { return std::make_unique<Client>(*this); }

  void Add(const std::string& id, const std::string& name, const std::string& state,
           const std::string& reason = "") {
    const std::lock_guard lock(mutex_);
    jobs.push_back({id, name, state, slurm::PhaseOf(state), reason, state == "PENDING" ? "" : "node1"});
  }
  void Set(const std::string& id, const std::string& state) {
    const std::lock_guard lock(mutex_);
    for (slurm::JobStatus& job : jobs) {
      if (job.id != id) continue;
      job.state = state;
      job.phase = slurm::PhaseOf(state);
    }
  }
  std::vector<std::string> names() {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> result;
    for (const slurm::JobStatus& job : jobs) result.push_back(job.name);
    return result;
  }

 private:
  class Client final : public slurm::SlurmClient {
   public:
    explicit Client(FakeSlurm& cluster) : cluster_(cluster) {}
    Result<std::string> Submit(const std::string& script,
                               const std::vector<std::string>& arguments) override {
      const std::lock_guard lock(cluster_.mutex_);
      if (!cluster_.refusal.empty()) return InvalidInput(cluster_.refusal);
      if (!cluster_.full.empty()) return Error{ErrorKind::kInUse, cluster_.full};
      if (!cluster_.hopeless.empty()) return Error{ErrorKind::kNotFound, cluster_.hopeless};
      cluster_.submitted.push_back(script);
      cluster_.options.push_back(arguments);
      const std::string id = cluster_.id_prefix + std::to_string(cluster_.next_id++);
      const std::string name = After(script, "--job-name=");
      const std::string array = After(script, "--array=1-");
      const int tasks = array.empty() ? 1 : std::stoi(array);
      for (int task = 1; task <= tasks; ++task) {
        cluster_.jobs.push_back({tasks == 1 ? id : id + "_" + std::to_string(task), name, "PENDING",
                                 slurm::JobPhase::kQueued, "", ""});
      }
      if (cluster_.loses_answers) return Error{ErrorKind::kIo, "no answer within 15000 ms"};
      return id;
    }
    Result<std::string> TestOnly(const std::string& script, const std::vector<std::string>&) override {
      const std::lock_guard lock(cluster_.mutex_);
      cluster_.tested.push_back(script);
      if (!cluster_.refusal.empty()) return InvalidInput(cluster_.refusal);
      return std::string("Job 3 to start at once");
    }
    Result<std::vector<slurm::JobStatus>> Queue(const std::string& prefix) override {
      const std::lock_guard lock(cluster_.mutex_);
      ++cluster_.queries;
      if (!cluster_.controller_error.empty()) return Error{ErrorKind::kIo, cluster_.controller_error};
      std::vector<slurm::JobStatus> found;
      for (const slurm::JobStatus& job : cluster_.jobs) {
        if (job.name.starts_with(prefix)) found.push_back(job);
      }
      return found;
    }
    Status Cancel(const std::vector<std::string>& ids) override {
      const std::lock_guard lock(cluster_.mutex_);
      if (cluster_.deaf) return Error{ErrorKind::kIo, "scancel: connect failure"};
      for (const std::string& id : ids) {
        cluster_.cancelled.push_back(id);
        std::erase_if(cluster_.jobs, [&](const slurm::JobStatus& job) { return job.id == id; });
      }
      return Ok{};
    }

   private:
    // What stands after `word` on its line; "" when it does not occur.
    static std::string After(const std::string& script, std::string_view word) {
      const std::size_t begin = script.find(word);
      if (begin == std::string::npos) return "";
      return script.substr(begin + word.size(), script.find('\n', begin) - begin - word.size());
    }

    FakeSlurm& cluster_;
  };

  std::mutex mutex_;
};

}  // namespace gauntlet::testing_support
