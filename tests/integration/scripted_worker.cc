#include "tests/integration/scripted_worker.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include "proto/message_codec.h"
#include "proto/run_codec.h"
#include "sim/run_result.h"
#include "tests/integration/campaign_driver.h"
#include "worker/golden_hash.h"
#include "worker/run_executor.h"

namespace gauntlet::testing_support {
namespace {

sim::RunResult Simulate(const proto::Lease& lease) {
  const Result<sim::RunSpec> spec = proto::DecodeRunSpec(lease.spec);
  EXPECT_TRUE(spec.ok()) << (spec.ok() ? "" : spec.error().message);
  return spec.ok() ? worker::Run(*spec) : sim::RunResult();
}

proto::LeaseResult ToMessage(const proto::Lease& lease, const sim::RunResult& result) {
  return {lease.fence, lease.run_id, proto::EncodeRunResult(result, proto::TrajectoryEncoding::kLeaveOut),
          std::nullopt, 0.01};
}

}  // namespace

ScriptedWorker::ScriptedWorker(const std::string& dir, std::uint64_t instance_id) : dir_(dir) {
  static const proto::GoldenHashes golden_hashes = worker::GoldenHashes();
  hello_.instance_id = instance_id;
  hello_.software_version = GAUNTLET_VERSION;
  hello_.golden_hashes = golden_hashes;
  hello_.process.host = "scripted";
  hello_.process.pid = getpid();
}

bool ScriptedWorker::Connect(std::uint64_t epoch) {
  return Eventually(
             [&] {
               Result<proto::Access> access = proto::ReadAccess(dir_ + "/access.json");
               if (!access || access->epoch < epoch) return false;
               access_ = *std::move(access);
               return true;
             },
             kPatience) &&
         connection_.Open(access_.endpoints.front(), access_.curve).ok();
}

bool ScriptedWorker::Join(std::uint64_t epoch) {
  if (!Connect(epoch)) return false;
  hello_.campaign_id = access_.campaign_id;
  Say(hello_);
  const auto welcome = HearA<proto::Welcome>();
  return welcome && welcome->epoch >= epoch;
}

void ScriptedWorker::Say(const proto::WorkerMessage& message) {
  SayBytes(proto::EncodeWorkerMessage(message));
}

void ScriptedWorker::SayBytes(std::string bytes) {
  connection_.Send(std::move(bytes));
  connection_.Flush();
}

void ScriptedWorker::Beat(const std::vector<proto::Fence>& held) {
  Say(proto::Heartbeat{1, held});
}

std::optional<proto::MasterMessage> ScriptedWorker::Hear(std::chrono::milliseconds patience) {
  std::optional<proto::MasterMessage> heard;
  Eventually(
      [&] {
        connection_.Flush();
        while (std::optional<std::string> frame = connection_.Receive()) {
          Result<proto::MasterMessage> message = proto::DecodeMasterMessage(*frame);
          EXPECT_TRUE(message.ok()) << (message.ok() ? "" : message.error().message);
          if (!message || std::holds_alternative<proto::Heartbeat>(*message)) continue;
          heard = *std::move(message);
          return true;
        }
        return false;
      },
      patience);
  return heard;
}

proto::LeaseResult ScriptedWorker::Answer(const proto::Lease& lease) {
  return ToMessage(lease, Simulate(lease));
}

proto::LeaseResult ScriptedWorker::WrongAnswer(const proto::Lease& lease) {
  sim::RunResult result = Simulate(lease);
  result.fitness += 1e-9;
  sim::SetHashes(result);
  return ToMessage(lease, result);
}

}  // namespace gauntlet::testing_support
