// A pool of worker allocations in a cluster: carries out what PoolPolicy decides.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/system/unique_fd.h"
#include "master/dispatch/pool/worker_pool.h"
#include "slurm/job_script.h"
#include "slurm/pool_policy.h"
#include "slurm/slurm_client.h"

namespace gauntlet::slurm {

struct SlurmPoolOptions {
  PoolLimits limits;
  JobRequest request;
  Cluster cluster = SlurmCluster();
  std::string job_template;  // of workers
  // `job.name` is the prefix of the jobs' names, unique to the campaign: whatever bears it is this
  // campaign's, also after a crash and when the answer of a submission was lost.
  WorkerJob job;
};

// A scheduler's commands take from milliseconds to many seconds, so a thread of the pool's own calls them;
// all methods return at once and belong to one thread. Jobs with the campaign's name that this pool did not
// submit (of an earlier master, or of a submission whose answer was lost) are adopted.
class SlurmPool final : public WorkerPool {
 public:
  // `job` and `job_template` have given a script once: that they do is checked when a campaign begins.
  SlurmPool(SlurmPoolOptions options, std::unique_ptr<SlurmClient> client);
  // Cancels what is still there, unless it was released.
  ~SlurmPool() override;
  SlurmPool(const SlurmPool&) = delete;
  SlurmPool& operator=(const SlurmPool&) = delete;

  // A cluster that starts nothing today may do so tomorrow; Trouble says what is wrong. Error: PoolPolicy has
  // given up.
  Result<std::vector<pid_t>> Supervise(TimePoint now) override;
  void AppendWaitFds(std::vector<int>& fds) const override { fds.push_back(answer_fd_.get()); }
  // Allocations that are not yet cancelled or ended.
  int running() const override;
  void StopReplacing() override { stopped_growing_ = true; }
  // Any signal: cancels all allocations; the cluster sends SIGTERM, then SIGKILL.
  void SignalAll(int signal) override;
  std::vector<DispatchEvent> TakeEvents() override { return std::exchange(events_, {}); }
  void Observe(const PoolView& view, TimePoint now) override;
  std::string Trouble(TimePoint now) const override;
  std::vector<AllocationView> Allocations() const override;
  // Nothing is submitted or cancelled any more.
  bool Release() override { return released_ = true; }

 private:
  using Task = std::function<std::function<void(TimePoint)>()>;  // a call; then what its answer means

  void Post(Task task);
  void CallCluster();
  void TakeAnswers(TimePoint now);
  void CarryOut(const Decisions& decisions);
  void PostSubmit(int allocations, const std::vector<std::string>& excluded_nodes);
  std::vector<std::string> Exclusion(const std::vector<std::string>& nodes) const;
  void PostQuery();
  void PostCancelAll();
  void PostCancel(const std::vector<std::string>& jobs);
  void OnQueue(std::vector<JobStatus> jobs, TimePoint now);
  void AddEnds(std::vector<JobStatus>& jobs) const;
  void Report(std::string text) { events_.push_back({event::kSlurm, std::move(text)}); }

  SlurmPoolOptions options_;
  std::unique_ptr<SlurmClient> client_;  // of the calling thread alone
  PoolPolicy policy_;
  Demand demand_;
  bool stopped_growing_ = false;
  bool adopted_ = false;  // the queue has been looked through: until then nothing is submitted
  bool adopting_ = false;
  bool released_ = false;
  std::optional<TimePoint> last_query_;
  int submitting_ = 0;  // submissions under way
  std::uint64_t next_number_ = 1;
  std::vector<std::string> cancelled_;  // still in the queue for a while
  std::string reported_trouble_;
  std::vector<DispatchEvent> events_;

  mutable std::mutex mutex_;
  std::condition_variable work_;
  std::deque<Task> tasks_;
  std::vector<std::function<void(TimePoint)>> answers_;
  bool leaving_ = false;
  const UniqueFd answer_fd_;  // eventfd, readable while there are answers
  std::thread thread_;
};

}  // namespace gauntlet::slurm
