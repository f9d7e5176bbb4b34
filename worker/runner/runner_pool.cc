#include "worker/runner/runner_pool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "base/check.h"

namespace gauntlet::worker {
namespace {

constexpr std::chrono::seconds kForkRetryDelay{1};
// Descriptors() holds the control socket, then pipe and output of every slot.
constexpr std::size_t kDescriptorsPerSlot = 2;

// poll ignores negative descriptors.
pollfd Watched(int fd, bool writing = false) {
  return {.fd = fd, .events = static_cast<short>(writing ? POLLIN | POLLOUT : POLLIN), .revents = 0};
}

// What may be the matter when no runner can be started.
std::string WhyNotStarted(int error) {
  const char* hint = error == EAGAIN   ? " (too many processes? ulimit -u, pids.max)"
                     : error == ENOMEM ? " (too little memory? ulimit -v, memory.max)"
                     : error == EMFILE || error == ENFILE || error == ETOOMANYREFS
                         ? " (too many open files? ulimit -n)"
                         : "";
  return fmt::format("cannot start a runner: {}{}", std::strerror(error), hint);
}

}  // namespace

RunnerPool::RunnerPool(ForkServer& server, int slots)
    : server_(server), slots_(static_cast<std::size_t>(slots)) {
  for (int i = 0; i < slots; ++i) server_.RequestRunner();
}

std::vector<pollfd> RunnerPool::Descriptors() const {
  std::vector<pollfd> descriptors;
  descriptors.reserve(1 + kDescriptorsPerSlot * slots_.size());
  descriptors.push_back(Watched(lost_ ? -1 : server_.fd(), server_.congested()));
  for (const Slot& slot : slots_) {
    descriptors.push_back(Watched(slot.pipe.get(), !slot.unsent.empty()));
    descriptors.push_back(Watched(slot.output.get()));
  }
  return descriptors;
}

std::vector<WorkerEvent> RunnerPool::Process(std::span<const pollfd> polled, TimePoint now) {
  std::vector<WorkerEvent> events;
  GAUNTLET_CHECK(polled.size() == 1 + kDescriptorsPerSlot * slots_.size(),
                 "Process takes what Descriptors gave");
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const pollfd& pipe = polled[1 + kDescriptorsPerSlot * i];
    const pollfd& output = polled[2 + kDescriptorsPerSlot * i];
    if (output.revents != 0) ReadOutput(slots_[i]);
    if ((pipe.revents & POLLOUT) != 0) SendRest(slots_[i]);
    if ((pipe.revents & ~POLLOUT) != 0) ReadReports(static_cast<int>(i), events);
  }
  if ((polled[0].revents & POLLOUT) != 0) server_.Flush();
  if ((polled[0].revents & ~POLLOUT) != 0) HandleServer(events, now);
  if (retry_at_ && now >= *retry_at_) {
    retry_at_.reset();
    for (; to_retry_ > 0; --to_retry_) server_.RequestRunner();
  }
  return events;
}

void RunnerPool::StartJob(int slot_index, const RunnerJob& job) {
  Slot& slot = slots_[static_cast<std::size_t>(slot_index)];
  // Its runner has ended, and the event that says so follows those that are being worked off.
  if (slot.pid < 0) return;
  if (slot.jobs == 0) {
    ReadOutput(slot);
    slot.output_tail.clear();
  }
  const std::string frame = MakeFrame(EncodeJob(job));
  ++slot.jobs;
  slot.unsent_frames.push_back(frame.size());
  slot.unsent += frame;
}

void RunnerPool::Flush() {
  for (Slot& slot : slots_) SendRest(slot);
}

void RunnerPool::Kill(int slot_index) {
  const Slot& slot = slots_[static_cast<std::size_t>(slot_index)];
  if (slot.pid >= 0 && !lost_) server_.Kill(slot.pid, SIGKILL);
}

void RunnerPool::HandleServer(std::vector<WorkerEvent>& events, TimePoint now) {
  while (std::optional<ForkServerEvent> event = server_.Receive()) {
    if (auto* started = std::get_if<RunnerStarted>(&*event)) {
      Started(std::move(*started), events);
    } else if (const auto* exited = std::get_if<RunnerExited>(&*event)) {
      Exited(*exited, events);
      // Whoever works these events off may give the slot another job before he comes to its end: that must
      // not reach the next runner.
      return;
    } else if (const auto* failed = std::get_if<RunnerNotStarted>(&*event)) {
      events.emplace_back(NoRunnerStarted{WhyNotStarted(failed->error)});
      ++to_retry_;
      retry_at_ = now + kForkRetryDelay;
    } else {
      lost_ = true;
      for (Slot& slot : slots_) slot = Slot{};
      events.emplace_back(AllRunnersLost{});
    }
  }
}

void RunnerPool::Started(RunnerStarted started, std::vector<WorkerEvent>& events) {
  const auto empty = std::ranges::find(slots_, -1, &Slot::pid);
  GAUNTLET_CHECK(empty != slots_.end(), "a runner started that nobody asked for");
  empty->pid = started.pid;
  empty->pipe = std::move(started.pipe);
  empty->output = std::move(started.output);
  fcntl(empty->output.get(), F_SETFL, O_NONBLOCK);
  events.emplace_back(SlotBecameReady{static_cast<int>(empty - slots_.begin())});
}

void RunnerPool::Exited(const RunnerExited& exited, std::vector<WorkerEvent>& events) {
  const auto slot = std::ranges::find(slots_, exited.pid, &Slot::pid);
  if (slot == slots_.end()) return;
  const int index = static_cast<int>(slot - slots_.begin());
  // A report that was complete counts, whatever happened to the runner afterwards.
  ReadReports(index, events);
  ReadOutput(*slot);
  if (slot->jobs > 0) {
    RunnerFailure failure = ClassifyExit(exited.wait_status, slot->output_tail);
    if (slot->broke_protocol) failure.kind = FailureKind::kCrashed;
    if (slot->unsent_frames.size() == slot->jobs)
      failure = {.kind = FailureKind::kExternal, .stderr_tail = "its runner ended before it had the job"};
    events.emplace_back(
        RunnerDied{index, std::move(failure), std::max(0.0, exited.cpu_seconds - slot->process_cpu_seconds)});
  } else {
    events.emplace_back(
        RunnerDied{.slot = index,
                   .failure = {.kind = FailureKind::kExternal, .stderr_tail = "its runner had ended"},
                   .at_work = false});
  }
  *slot = Slot{};
  server_.RequestRunner();
}

void RunnerPool::ReadReports(int slot_index, std::vector<WorkerEvent>& events) {
  Slot& slot = slots_[static_cast<std::size_t>(slot_index)];
  if (!slot.pipe.valid()) return;
  const FrameBuffer::State state = slot.reports.ReadFrom(slot.pipe.get());
  while (const std::optional<std::string> frame = slot.reports.Next()) {
    std::optional<RunnerReport> report = DecodeReport(*frame);
    if (!report || slot.jobs <= slot.unsent_frames.size()) return BreakOff(slot);
    --slot.jobs;
    slot.process_cpu_seconds = report->process_cpu_seconds;
    events.emplace_back(RunFinished{slot_index, std::move(report->result), report->cpu_seconds});
  }
  if (state == FrameBuffer::State::kDamaged) return BreakOff(slot);
  if (state == FrameBuffer::State::kEnded) {
    // The runner is dying, and its status stands already; the signal is for one that closed its pipe and
    // lives.
    slot.pipe.Reset();
    server_.Kill(slot.pid, SIGKILL);
  }
}

void RunnerPool::BreakOff(Slot& slot) {
  slot.broke_protocol = true;
  slot.pipe.Reset();
  server_.Kill(slot.pid, SIGKILL);
}

void RunnerPool::ReadOutput(Slot& slot) {
  // A run that prints without end gets its turn again in the next round: nothing waits for it.
  constexpr int kReadsPerTurn = 16;
  std::array<char, 4096> chunk;
  for (int i = 0; i < kReadsPerTurn && slot.output.valid(); ++i) {
    const ssize_t got = read(slot.output.get(), chunk.data(), chunk.size());
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (got <= 0) {
      slot.output.Reset();
      return;
    }
    slot.output_tail.append(chunk.data(), static_cast<std::size_t>(got));
    if (slot.output_tail.size() > kMaxStderrTail) {
      slot.output_tail.erase(0, slot.output_tail.size() - kMaxStderrTail);
    }
  }
}

void RunnerPool::SendRest(Slot& slot) {
  while (!slot.unsent.empty() && slot.pipe.valid()) {
    const ssize_t sent =
        send(slot.pipe.get(), slot.unsent.data(), slot.unsent.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return;  // full (poll tells when to go on) or closed (its exit will be reported)
    slot.unsent.erase(0, static_cast<std::size_t>(sent));
    std::size_t left = static_cast<std::size_t>(sent);
    while (left > 0 && left >= slot.unsent_frames.front()) {
      left -= slot.unsent_frames.front();
      slot.unsent_frames.pop_front();
    }
    if (left > 0) slot.unsent_frames.front() -= left;
  }
}

}  // namespace gauntlet::worker
