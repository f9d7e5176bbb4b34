#include "tests/integration/liar.h"

#include <chrono>
#include <deque>
#include <optional>

#include "proto/run_codec.h"

namespace gauntlet::testing_support {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kLate{400};
constexpr milliseconds kBeat{500};

proto::LeaseResult Failure(const proto::Lease& lease, proto::FailureKind kind, int signal) {
  return {.fence = lease.fence,
          .run_id = lease.run_id,
          .failure = proto::RunnerFailure{.kind = kind, .signal = signal, .stderr_tail = "a lie"}};
}

}  // namespace

std::string_view NameOf(Lie lie) {
  constexpr std::string_view kNames[] = {"honest",     "crash",         "hang", "wrong hash",
                                         "unreadable", "foreign lease", "slow"};
  return kNames[static_cast<std::size_t>(lie)];
}

Liar::Liar(const std::string& dir, Lie lie, std::uint64_t instance_id)
    : lie_(lie), worker_(dir, instance_id), joined_(worker_.Join()) {
  if (joined_) thread_ = std::jthread([this](const std::stop_token& stop) { Work(stop); });
}

Liar::~Liar() = default;

void Liar::Work(const std::stop_token& stop) {
  struct Late {
    steady_clock::time_point due;
    proto::Lease lease;
  };
  std::deque<Late> late;
  auto next_beat = steady_clock::now();
  while (!stop.stop_requested()) {
    const std::optional<proto::MasterMessage> message = worker_.Hear(milliseconds(20));
    if (message && std::holds_alternative<proto::Drain>(*message)) return worker_.Say(proto::Goodbye{"done"});
    if (const auto* lease = message ? std::get_if<proto::Lease>(&*message) : nullptr) {
      ++leases_;
      if (lie_ == Lie::kSlow) {
        late.push_back({steady_clock::now() + kLate, *lease});
      } else {
        Answer(*lease);
      }
    }
    const auto now = steady_clock::now();
    for (; !late.empty() && late.front().due <= now; late.pop_front())
      worker_.Say(ScriptedWorker::Answer(late.front().lease));
    if (now < next_beat) continue;
    next_beat = now + kBeat;
    std::vector<proto::Fence> held;
    for (const Late& one : late) held.push_back(one.lease.fence);
    worker_.Beat(held);
  }
}

void Liar::Answer(const proto::Lease& lease) {
  switch (lie_) {
    case Lie::kCrash:
      return worker_.Say(Failure(lease, proto::FailureKind::kCrashed, 11));
    case Lie::kHang:
      return worker_.Say(Failure(lease, proto::FailureKind::kHung, 0));
    case Lie::kWrongHash: {
      proto::LeaseResult answer = ScriptedWorker::Answer(lease);
      Result<sim::RunResult> result = proto::DecodeRunResult(answer.result);
      if (result) {
        result->fitness += 1e-9;  // and the old hash
        answer.result = proto::EncodeRunResult(*result);
      }
      return worker_.Say(answer);
    }
    case Lie::kUnreadable:
      return worker_.Say(
          proto::LeaseResult{.fence = lease.fence, .run_id = lease.run_id, .result = "\xff\xff"});
    case Lie::kForeignLease:
      // Somebody else has the one before it and the one after it, if anybody has.
      for (const proto::Fence fence : {lease.fence - 1, lease.fence + 1}) {
        proto::Lease foreign = lease;
        foreign.fence = fence;
        for (const proto::RunId run : {lease.run_id - 1, lease.run_id, lease.run_id + 1}) {
          foreign.run_id = run;
          worker_.Say(Failure(foreign, proto::FailureKind::kCrashed, 11));
        }
      }
      return;
    case Lie::kNone:
    case Lie::kSlow:
      return worker_.Say(ScriptedWorker::Answer(lease));
  }
}

}  // namespace gauntlet::testing_support
