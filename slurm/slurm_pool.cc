#include "slurm/slurm_pool.h"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <set>

#include "base/check.h"
#include "base/number_text.h"
#include "base/split.h"
#include "base/system/regular_file.h"

namespace gauntlet::slurm {

SlurmPool::SlurmPool(SlurmPoolOptions options, std::unique_ptr<SlurmClient> client)
    : options_(std::move(options)),
      client_(std::move(client)),
      policy_(options_.limits, options_.cluster),
      answer_fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  GAUNTLET_CHECK(answer_fd_.valid(), "no eventfd can be had");
  thread_ = std::thread([this] { CallCluster(); });
}

SlurmPool::~SlurmPool() {
  StopReplacing();
  {
    const std::lock_guard lock(mutex_);
    tasks_.clear();
  }
  if (!released_) PostCancelAll();
  {
    const std::lock_guard lock(mutex_);
    leaving_ = true;
  }
  work_.notify_all();
  thread_.join();
}

// By name, so that a submission whose answer was lost goes too; without an answer at least those that are
// known.
void SlurmPool::PostCancelAll() {
  std::vector<std::string> known;
  for (const Allocation& allocation : policy_.allocations()) known.push_back(allocation.job);
  Post([this, living = std::move(known)]() mutable -> std::function<void(TimePoint)> {
    if (const Result<std::vector<JobStatus>> jobs = client_->Queue(options_.job.name); jobs) {
      living.clear();
      for (const JobStatus& job : *jobs) {
        if (job.phase != JobPhase::kEnded) living.push_back(job.id);
      }
    }
    (void)client_->Cancel(living).ok();
    return [](TimePoint) {};
  });
}

void SlurmPool::Post(Task task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  work_.notify_all();
}

// The thread: one call after the other, until there are none and the pool is leaving.
void SlurmPool::CallCluster() {
  while (true) {
    Task task;
    {
      std::unique_lock lock(mutex_);
      work_.wait(lock, [this] { return leaving_ || !tasks_.empty(); });
      if (tasks_.empty()) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    std::function<void(TimePoint)> answer = task();
    const std::lock_guard lock(mutex_);
    answers_.push_back(std::move(answer));
    const std::uint64_t one = 1;
    GAUNTLET_CHECK(write(answer_fd_.get(), &one, sizeof one) == sizeof one, "the eventfd of the pool broke");
  }
}

void SlurmPool::TakeAnswers(TimePoint now) {
  std::vector<std::function<void(TimePoint)>> answers;
  {
    const std::lock_guard lock(mutex_);
    answers.swap(answers_);
    std::uint64_t count = 0;
    (void)!read(answer_fd_.get(), &count, sizeof count);
  }
  for (const auto& answer : answers) answer(now);
}

Result<std::vector<pid_t>> SlurmPool::Supervise(TimePoint now) {
  TakeAnswers(now);
  if (released_) return std::vector<pid_t>{};
  if (!adopted_) {
    const bool may_ask = !last_query_ || now - *last_query_ >= options_.limits.query_interval;
    if (!adopting_ && may_ask) {
      adopting_ = true;
      last_query_ = now;
      PostQuery();
    }
  } else if (!stopped_growing_) {
    const Decisions decisions = policy_.Decide(demand_, now);
    if (decisions.query) last_query_ = now;
    CarryOut(decisions);
  }
  if (std::string trouble = Trouble(now); trouble != reported_trouble_) {
    // The seconds to the next try change all the time: the words before them are the news.
    const auto words = [](const std::string& text) { return text.substr(0, text.find("; the next try")); };
    if (!trouble.empty() && words(trouble) != words(reported_trouble_)) Report(trouble);
    reported_trouble_ = std::move(trouble);
  }
  if (const std::string why = policy_.GivenUp(); !why.empty())
    return Error{ErrorKind::kIo, why + NextStep(why, options_.cluster)};
  return std::vector<pid_t>{};
}

void SlurmPool::CarryOut(const Decisions& decisions) {
  PostCancel(decisions.cancel);
  // Equal ones are an array; where there are no arrays, the next one waits for the answer to the last.
  int wanted = decisions.submit - submitting_;
  if (options_.cluster.task_id.empty()) wanted = submitting_ > 0 ? 0 : std::min(wanted, 1);
  if (wanted > 0) PostSubmit(wanted, decisions.exclude_nodes);
  if (decisions.query) PostQuery();
}

// The options of `exclude`, which stand apart by blanks.
std::vector<std::string> SlurmPool::Exclusion(const std::vector<std::string>& nodes) const {
  std::vector<std::string> options;
  if (!nodes.empty()) options = WordsOf(options_.cluster.exclude);
  for (std::string& option : options)
    option =
        Replaced(option, "@NODES@", fmt::format("{}", fmt::join(nodes, options_.cluster.node_separator)));
  return options;
}

void SlurmPool::PostSubmit(int allocations, const std::vector<std::string>& excluded_nodes) {
  WorkerJob job = options_.job;
  job.name += fmt::format("{}", next_number_++);
  job.array = allocations;
  const Result<std::string> script =
      WorkerScript(options_.job_template, job, options_.request, options_.cluster);
  GAUNTLET_CHECK(script.ok(), "the worker script was checked when the campaign began");
  submitting_ += allocations;
  Post([this, text = *script, arguments = Exclusion(excluded_nodes),
        allocations]() -> std::function<void(TimePoint)> {
    return [this, id = client_->Submit(text, arguments), allocations](TimePoint now) {
      submitting_ -= allocations;
      if (id) {
        if (allocations == 1) policy_.Submitted(*id, now);
        for (int task = 1; allocations > 1 && task <= allocations; ++task)
          policy_.Submitted(
              Replaced(Replaced(options_.cluster.task_id, "@JOB@", *id), "@TASK@", fmt::format("{}", task)),
              now);
        Report(fmt::format("job {} submitted: {} of {}", *id, Counted(allocations, "allocation"),
                           Counted(options_.job.slots, "slot")));
        return;
      }
      policy_.SubmissionFailed(id.error().message, now, id.error().kind);
      // It may have been accepted all the same, or there may be room again: look before the next one.
      adopted_ = false;
    };
  });
}

void SlurmPool::PostQuery() {
  Post([this]() -> std::function<void(TimePoint)> {
    return [this, jobs = client_->Queue(options_.job.name)](TimePoint now) mutable {
      adopting_ = false;
      if (jobs) {
        OnQueue(std::move(*jobs), now);
      } else {
        policy_.QueryFailed(jobs.error().message, now, jobs.error().kind);
      }
    };
  });
}

void SlurmPool::PostCancel(const std::vector<std::string>& jobs) {
  if (jobs.empty()) return;
  std::vector<std::string> news;
  for (const std::string& job : jobs) {
    if (std::ranges::count(cancelled_, job) == 0) news.push_back(job);
  }
  cancelled_.insert(cancelled_.end(), news.begin(), news.end());
  if (!news.empty())
    Report(fmt::format("cancelled {} {}", Plural(news.size(), "job"), fmt::join(news, ", ")));
  Post([this, jobs]() -> std::function<void(TimePoint)> {
    return [this, done = client_->Cancel(jobs)](TimePoint now) {
      if (!done) policy_.QueryFailed(done.error().message, now);
    };
  });
}

// A job that the queue does not show has left its exit code (slurm/run_job.sh), if it came to its end.
void SlurmPool::AddEnds(std::vector<JobStatus>& jobs) const {
  constexpr std::size_t kMostBytes = 16;
  for (const Allocation& allocation : policy_.allocations()) {
    if (std::ranges::count(jobs, allocation.job, &JobStatus::id) > 0) continue;
    const Result<std::string> code =
        ReadRegularFile(fmt::format("{}/{}.exit", options_.job.log_directory, allocation.job), kMostBytes);
    if (!code) continue;
    const std::string_view digits = Trimmed(*code);
    jobs.push_back({allocation.job, "", digits == "0" ? "COMPLETED" : "FAILED", JobPhase::kEnded,
                    fmt::format("exit code {}", digits), ""});
  }
}

void SlurmPool::OnQueue(std::vector<JobStatus> jobs, TimePoint now) {
  AddEnds(jobs);
  adopted_ = true;
  const std::set<std::string> cancelled(cancelled_.begin(), cancelled_.end());
  std::set<std::string> known = cancelled;
  std::vector<std::string> undead;
  for (const Allocation& allocation : policy_.allocations()) known.insert(allocation.job);
  for (const JobStatus& job : jobs) {
    const bool lives = job.phase == JobPhase::kQueued || job.phase == JobPhase::kRunning;
    // A cancellation that the controller never got.
    if (lives && cancelled.contains(job.id)) undead.push_back(job.id);
    // While a submission is under way its job may be in the queue before its answer is here.
    if (!lives || submitting_ > 0 || known.contains(job.id)) continue;
    policy_.Adopt(job, now);
    Report(fmt::format("adopted job {} ({})", job.id, job.state));
  }
  if (!undead.empty()) PostCancel(undead);
  policy_.Observed(jobs, now);
}

void SlurmPool::Observe(const PoolView& view, TimePoint now) {
  demand_.unfinished_runs = view.unfinished_runs;
  for (const Allocation& allocation : policy_.allocations()) {
    int connected = 0;
    int busy = 0;
    for (const PoolView::Worker& worker : view.workers) {
      // "job:restart:node", as slurm/worker.sbatch passes it.
      if (!worker.allocation.starts_with(allocation.job + ":")) continue;
      ++connected;
      if (worker.busy) ++busy;
    }
    policy_.Workers(allocation.job, connected, busy, now);
  }
}

std::string SlurmPool::Trouble(TimePoint now) const {
  const std::string trouble = policy_.Trouble(now);
  return trouble.empty() ? "" : trouble + NextStep(trouble, options_.cluster);
}

std::vector<AllocationView> SlurmPool::Allocations() const {
  const std::vector<Allocation> allocations = policy_.allocations();
  return {allocations.begin(), allocations.end()};
}

int SlurmPool::running() const {
  int living = submitting_;
  for (const Allocation& allocation : policy_.allocations()) living += allocation.cancelled ? 0 : 1;
  return living;
}

void SlurmPool::SignalAll(int /*signal*/) {
  if (released_) return;
  policy_.Stop();
  CarryOut(policy_.Decide({}, {}));
}

}  // namespace gauntlet::slurm
