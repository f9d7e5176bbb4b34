#include "proto/message_codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "proto/protocol.pb.h"

namespace gauntlet::proto {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

v1::Envelope Encoded(const WorkerMessage& message) {
  v1::Envelope envelope;
  EXPECT_TRUE(envelope.ParseFromString(EncodeWorkerMessage(message)));
  return envelope;
}

TEST(MessageCodecTest, HelloCarriesTheProtocolVersionAndWhoTheWorkerIs) {
  const v1::Hello hello = Encoded(Hello{.campaign_id = "c0ffee",
                                        .instance_id = 1ULL << 63,
                                        .software_version = "1.2.3",
                                        .slots = 4,
                                        .process = {"node1", "", "", 4321, 0},
                                        .held_leases = {9, 1ULL << 60},
                                        .allocation = "12_3:0:node1",
                                        .golden_hashes = {{"boids", 77}}})
                              .hello();
  EXPECT_EQ(hello.protocol_version(), 1u);
  EXPECT_EQ(hello.campaign_id(), "c0ffee");
  EXPECT_EQ(hello.instance_id(), 1ULL << 63);
  EXPECT_EQ(hello.software_version(), "1.2.3");
  EXPECT_EQ(hello.golden_hashes(0).controller(), "boids");
  EXPECT_EQ(hello.golden_hashes(0).hash(), 77u);
  EXPECT_EQ(hello.slots(), 4u);
  EXPECT_EQ(hello.host(), "node1");
  EXPECT_EQ(hello.pid(), 4321);
  EXPECT_THAT(hello.held_leases(), ElementsAre(9, 1ULL << 60));
  EXPECT_EQ(hello.allocation(), "12_3:0:node1");
}

TEST(MessageCodecTest, ResultWithoutFailureHasNoFailureOnTheWire) {
  const v1::LeaseResult result =
      Encoded(LeaseResult{.fence = 5, .run_id = 6, .result = "bytes\xff", .failure = {}, .cpu_seconds = 0.25})
          .lease_result();
  EXPECT_EQ(result.fence(), 5u);
  EXPECT_EQ(result.run_id(), 6u);
  EXPECT_EQ(result.result(), "bytes\xff");
  EXPECT_FALSE(result.has_failure());
  EXPECT_EQ(result.cpu_seconds(), 0.25);
}

TEST(MessageCodecTest, KindsOfFailureAreTheWires) {
  const auto kind_of = [](FailureKind kind) {
    return Encoded(LeaseResult{.fence = 5,
                               .run_id = 6,
                               .result = {},
                               .failure = RunnerFailure{kind, 6, 0, "tail"},
                               .cpu_seconds = 0})
        .lease_result()
        .failure()
        .kind();
  };
  EXPECT_EQ(kind_of(FailureKind::kCrashed), v1::RunnerFailure::KIND_CRASHED);
  EXPECT_EQ(kind_of(FailureKind::kHung), v1::RunnerFailure::KIND_HUNG);
  EXPECT_EQ(kind_of(FailureKind::kOutOfMemory), v1::RunnerFailure::KIND_OUT_OF_MEMORY);
  EXPECT_EQ(kind_of(FailureKind::kExternal), v1::RunnerFailure::KIND_EXTERNAL);
}

TEST(MessageCodecTest, DecodesWhatMastersSend) {
  v1::Envelope envelope;
  envelope.mutable_lease()->set_fence(3);
  envelope.mutable_lease()->set_run_id(4);
  envelope.mutable_lease()->set_spec(std::string("a\0b", 3));
  envelope.mutable_lease()->set_attempt(2);
  envelope.mutable_lease()->set_result_wait_ms(500);
  const auto lease = DecodeMasterMessage(envelope.SerializeAsString());
  ASSERT_TRUE(lease.ok());
  EXPECT_EQ(std::get<Lease>(*lease).spec, std::string("a\0b", 3));
  EXPECT_EQ(std::get<Lease>(*lease).attempt, 2u);
  EXPECT_EQ(std::get<Lease>(*lease).result_wait, std::chrono::milliseconds(500));

  envelope.mutable_welcome()->set_heartbeat_ms(250);
  envelope.mutable_welcome()->set_memory_limit_bytes(1 << 20);
  envelope.mutable_welcome()->set_without_ways(true);
  const auto welcome = DecodeMasterMessage(envelope.SerializeAsString());
  ASSERT_TRUE(welcome.ok());
  EXPECT_EQ(std::get<Welcome>(*welcome).heartbeat, std::chrono::milliseconds(250));
  EXPECT_TRUE(std::get<Welcome>(*welcome).without_ways);

  envelope.mutable_acknowledge()->add_fences(8);
  EXPECT_THAT(std::get<Acknowledge>(*DecodeMasterMessage(envelope.SerializeAsString())).fences,
              ElementsAre(8));
  envelope.mutable_cancel()->set_fence(9);
  EXPECT_EQ(std::get<Cancel>(*DecodeMasterMessage(envelope.SerializeAsString())).fence, 9u);
  envelope.mutable_drain()->set_finish_current(true);
  EXPECT_TRUE(std::get<Drain>(*DecodeMasterMessage(envelope.SerializeAsString())).finish_current);
  envelope.mutable_refused()->set_reason("no");
  EXPECT_EQ(std::get<Refused>(*DecodeMasterMessage(envelope.SerializeAsString())).reason, "no");
  envelope.mutable_heartbeat()->set_sequence(12);
  EXPECT_EQ(std::get<Heartbeat>(*DecodeMasterMessage(envelope.SerializeAsString())).sequence, 12u);
}

TEST(MessageCodecTest, RefusesWhatOnlyWorkersSend) {
  for (const WorkerMessage& message :
       {WorkerMessage(Hello{}), WorkerMessage(LeaseResult{}), WorkerMessage(Goodbye{})}) {
    const auto decoded = DecodeMasterMessage(EncodeWorkerMessage(message));
    ASSERT_FALSE(decoded.ok());
    EXPECT_THAT(decoded.error().message, HasSubstr("only workers send"));
  }
}

TEST(MessageCodecTest, RefusesHeartbeatsThatWouldFloodOrNeverCome) {
  for (const std::uint32_t heartbeat : {0u, 9u, 4'000'000u}) {
    v1::Envelope envelope;
    envelope.mutable_welcome()->set_heartbeat_ms(heartbeat);
    const auto decoded = DecodeMasterMessage(envelope.SerializeAsString());
    ASSERT_FALSE(decoded.ok());
    EXPECT_EQ(decoded.error().message,
              "welcome: heartbeat_ms is " + std::to_string(heartbeat) + ", 10 to 600000 is possible");
  }
}

TEST(MessageCodecTest, RefusesAnUnknownMessageOfALaterVersion) {
  v1::Envelope envelope;
  envelope.GetReflection()->MutableUnknownFields(&envelope)->AddLengthDelimited(99, "future");
  EXPECT_EQ(DecodeMasterMessage(envelope.SerializeAsString()).error().message,
            "an envelope without a message that this version knows");
  EXPECT_FALSE(DecodeMasterMessage("").ok());
}

TEST(MessageCodecTest, RefusesAnOversizedMessage) {
  EXPECT_EQ(DecodeMasterMessage(std::string(kMaxMessageBytes + 1, 'x')).error().message,
            "a message of 16777217 bytes, 16777216 are allowed");
}

TEST(MessageCodecTest, WhatAWorkerSaysReachesTheMasterAsItWas) {
  const Hello hello{.campaign_id = "c0ffee",
                    .instance_id = 1ULL << 63,
                    .software_version = "1.2.3",
                    .slots = 4,
                    .process = {"node1", "a-boot", "pid:[4026531836]", 4321, 123456},
                    .held_leases = {9, 1ULL << 60},
                    .allocation = "12_3:0:node1",
                    .golden_hashes = {{"boids", 77}, {"foragers", 78}}};
  EXPECT_EQ(std::get<Hello>(*DecodeWorkerMessage(EncodeWorkerMessage(hello))), hello);
  LeaseResult result{.fence = 7, .run_id = 8, .result = "bytes", .failure = {}, .cpu_seconds = 0.5};
  EXPECT_EQ(std::get<LeaseResult>(*DecodeWorkerMessage(EncodeWorkerMessage(result))), result);
  for (const FailureKind kind :
       {FailureKind::kCrashed, FailureKind::kHung, FailureKind::kOutOfMemory, FailureKind::kExternal}) {
    result.failure = RunnerFailure{kind, 11, 3, "last words"};
    EXPECT_EQ(std::get<LeaseResult>(*DecodeWorkerMessage(EncodeWorkerMessage(result))), result);
  }
  const auto heartbeat = DecodeWorkerMessage(EncodeWorkerMessage(Heartbeat{5, {1, 2}}));
  EXPECT_THAT(std::get<Heartbeat>(*heartbeat).held_leases, ElementsAre(1, 2));
}

TEST(MessageCodecTest, TheMasterReadsLenientlyWhatAWorkerSays) {
  v1::Envelope envelope;
  envelope.mutable_hello()->set_protocol_version(9);
  envelope.mutable_hello()->set_pid(std::int64_t{1} << 40);
  const Result<WorkerMessage> hello = DecodeWorkerMessage(envelope.SerializeAsString());
  ASSERT_TRUE(hello.ok());
  EXPECT_EQ(std::get<Hello>(*hello).protocol_version, 9u);
  EXPECT_EQ(std::get<Hello>(*hello).process.pid, 0) << "no process of ours";

  v1::RunnerFailure& failure = *envelope.mutable_lease_result()->mutable_failure();
  failure.set_kind(static_cast<v1::RunnerFailure::Kind>(77));
  failure.set_stderr_tail("x" + std::string(kMaxStderrTail, 'y'));
  const Result<WorkerMessage> result = DecodeWorkerMessage(envelope.SerializeAsString());
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(std::get<LeaseResult>(*result).failure->kind, FailureKind::kExternal);
  EXPECT_EQ(std::get<LeaseResult>(*result).failure->stderr_tail, std::string(kMaxStderrTail, 'y'));

  EXPECT_EQ(DecodeWorkerMessage(EncodeMasterMessage(Cancel{3})).error().message,
            "is a message that only a master sends");
  EXPECT_EQ(DecodeWorkerMessage("").error().message,
            "is an envelope with no message that this version knows");
}

RC_GTEST_PROP(MessageCodecProperty, GarbageIsAnErrorNeverACrash, (const std::string& bytes)) {
  const auto of_a_master = DecodeMasterMessage(bytes);
  if (!of_a_master.ok()) RC_ASSERT(!of_a_master.error().message.empty());
  const auto of_a_worker = DecodeWorkerMessage(bytes);
  if (!of_a_worker.ok()) RC_ASSERT(!of_a_worker.error().message.empty());
}

}  // namespace
}  // namespace gauntlet::proto
