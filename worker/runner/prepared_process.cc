#include "worker/runner/prepared_process.h"

#include <malloc.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <span>
#include <system_error>
#include <utility>

#include "base/canonical_encoder.h"
#include "base/system/process_tree.h"
#include "base/system/resource_limits.h"
#include "worker/runner/fork_server.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;

// What the process says first: whether calls can be forked from it.
constexpr const char* kPrepared = "prepared";
constexpr const char* kUnfit = "unfit";

struct Request {
  std::string request;
  SeparateOptions options;
};

std::string Encode(const std::string& request, const SeparateOptions& options) {
  CanonicalEncoder encoder;
  encoder.String(request);
  encoder.Double(options.cpu_limit_seconds);
  encoder.Uint(options.memory_limit_bytes);
  encoder.Uint(options.wall_limit_seconds);
  encoder.String(options.scratch);
  return encoder.Take();
}

Request DecodeRequest(const std::string& bytes) {
  CanonicalDecoder decoder(bytes);
  Request request;
  request.request = decoder.String();
  request.options.cpu_limit_seconds = decoder.Double();
  request.options.memory_limit_bytes = decoder.Uint();
  request.options.wall_limit_seconds = static_cast<unsigned>(decoder.Uint());
  request.options.scratch = decoder.String();
  GAUNTLET_CHECK(decoder.ok() && decoder.AtEnd(), "a request that does not decode");
  return request;
}

std::string Encode(const Result<SeparateOutcome>& outcome) {
  CanonicalEncoder encoder;
  encoder.Double(SecondsWithChildren());
  encoder.Bool(outcome.ok());
  if (!outcome) {
    encoder.String(outcome.error().message);
    return encoder.Take();
  }
  encoder.Int(outcome->wait_status);
  encoder.String(outcome->output_tail);
  encoder.Bool(outcome->bytes.has_value());
  if (outcome->bytes) encoder.String(*outcome->bytes);
  return encoder.Take();
}

Result<SeparateOutcome> DecodeOutcome(const std::string& bytes, double& cpu_seconds) {
  CanonicalDecoder decoder(bytes);
  cpu_seconds = decoder.Double();
  if (!decoder.Bool()) return Error{ErrorKind::kIo, decoder.String()};
  SeparateOutcome outcome;
  outcome.wait_status = static_cast<int>(decoder.Int());
  outcome.output_tail = decoder.String();
  if (decoder.Bool()) outcome.bytes = decoder.String();
  GAUNTLET_CHECK(decoder.ok() && decoder.AtEnd(), "an outcome that does not decode");
  return outcome;
}

std::ptrdiff_t EntriesIn(const char* folder) {
  std::error_code failed;
  const fs::directory_iterator entries(folder, failed);
  return failed ? -1 : std::distance(begin(entries), end(entries));
}

}  // namespace

Result<SeparateOutcome> PreparedProcess::Call(const std::string& request, const SeparateOptions& options) {
  if (options.memory_limit_bytes != memory_limit_bytes_) End();
  if (process_ == 0) {
    TRY(std::optional<SeparateOutcome> ended, Start(options));
    if (ended) return *std::move(ended);
  }
  SeparateOptions with_folder = options;
  if (options.scratch.empty()) {
    TRY(RenewFolder());
    with_folder.scratch = folder_->path();
  } else {
    TRY(ScratchFolder::Make(options.scratch));
  }
  std::optional<std::string> answer;
  if (WriteFrame(pipe_.get(), Encode(request, with_folder))) answer = Answer(options.cpu_limit_seconds);
  if (!answer) return Reap();
  TRY(SeparateOutcome outcome, DecodeOutcome(*answer, cpu_seconds_));
  if (over_limit_ && !outcome.bytes) outcome.wait_status = SIGXCPU;
  return outcome;
}

Result<std::optional<SeparateOutcome>> PreparedProcess::Start(const SeparateOptions& options) {
  TRY(RenewFolder());
  TRY(SocketPair pipe, MakeSocketPair(SOCK_STREAM));
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) return SystemError("cannot start a process", errno);
  if (child == 0) {
    pipe.first.Reset();
    Live(std::move(pipe.second), parent, options);
  }
  process_ = child;
  memory_limit_bytes_ = options.memory_limit_bytes;
  pipe.second.Reset();
  pipe_ = std::move(pipe.first);
  answers_ = FrameBuffer();
  std::optional<Packet> confined = ReceivePacket(pipe_.get(), 1, 0);
  if (confined && !confined->descriptors.empty()) guard_.emplace(std::move(confined->descriptors[0]), child);
  const std::optional<std::string> answer = Answer(options.cpu_limit_seconds);
  if (!answer) return std::optional(Reap());
  if (for_each_call_ || (*answer == kPrepared && folder_->HoldsOnlyEmpty(kOutputFile)))
    return std::optional<SeparateOutcome>();
  for_each_call_ = true;
  End();
  return Start(options);
}

void PreparedProcess::Live(UniqueFd pipe, pid_t parent, const SeparateOptions& options) {
  setsid();  // without a terminal
  if (!DieWithParent(parent)) _exit(0);
  if (!MoveInto(folder_->path())) _exit(kExitWithoutPlugin);
  folder_->LeaveToParent();
  const Result<ResultFile> result = ResultFile::Make();
  if (!result) _exit(kExitWithoutPlugin);
  std::set<int> kept = files_;
  kept.insert({pipe.get(), result->descriptor()});
  CloseAllBut(kept);
  TakeOrphans();
  LimitForGood(options);
  LimitTime(options);
  {
    const UniqueFd listener = ConfineToTree();
    const std::array descriptors{listener.get()};
    const std::span<const int> sent(descriptors.data(), listener.valid() ? 1 : 0);
    if (!SendPacket(pipe.get(), "c", sent)) _exit(0);
  }
  const std::ptrdiff_t descriptors = EntriesIn("/proc/self/fd");
  CallOrEnd([this] {
    if (!for_each_call_) prepare_();
    return std::string();
  });
  std::fflush(nullptr);
  const bool fit =
      EntriesIn("/proc/self/fd") == descriptors && EntriesIn("/proc/self/task") == 1 && !HasChildren();
  // What is free in the heap, a call touches first, which costs less than a copy of it; and what the call
  // allocates beyond lies at the heap's end, where large pages begin.
  malloc_trim(0);
  if (!WriteFrame(pipe.get(), fit ? kPrepared : kUnfit)) _exit(0);
  alarm(0);
  SetSoftLimit(RLIMIT_CPU, RLIM_INFINITY);
  Serve(std::move(pipe), *result);
}

void PreparedProcess::Serve(UniqueFd pipe, const ResultFile& result) const {
  FrameBuffer requests;
  while (true) {
    const std::optional<std::string> message = requests.Next();
    if (!message) {
      if (requests.ReadFrom(pipe.get(), FrameBuffer::Wait::kYes) != FrameBuffer::State::kOpen) _exit(0);
      continue;
    }
    const Request request = DecodeRequest(*message);
    const auto work = [&] {
      pipe.Reset();
      if (for_each_call_) prepare_();
      return work_(request.request);
    };
    if (!WriteFrame(pipe.get(), Encode(CallInSeparateProcess(work, request.options, result)))) _exit(0);
  }
}

std::optional<std::string> PreparedProcess::Answer(double cpu_limit) {
  over_limit_ = false;
  while (true) {
    if (std::optional<std::string> answer = answers_.Next()) return answer;
    if (guard_) over_limit_ = guard_->ServeUntilReadable(pipe_.get(), cpu_limit) || over_limit_;
    if (answers_.ReadFrom(pipe_.get(), FrameBuffer::Wait::kYes) != FrameBuffer::State::kOpen)
      return std::nullopt;
  }
}

SeparateOutcome PreparedProcess::Reap() {
  pipe_.Reset();
  guard_.reset();
  cpu_seconds_ = 0.0;
  SeparateOutcome outcome;
  outcome.wait_status = WaitForGroup(std::exchange(process_, 0));
  outcome.output_tail = OutputTail(folder_->path());
  return outcome;
}

void PreparedProcess::End() {
  if (process_ != 0) Reap();
}

Status PreparedProcess::RenewFolder() {
  if (folder_ && folder_->HoldsOnlyEmpty(kOutputFile)) return Ok{};
  folder_.reset();
  TRY(ScratchFolder made, ScratchFolder::Make(""));
  folder_.emplace(std::move(made));
  return Ok{};
}

}  // namespace gauntlet::worker
