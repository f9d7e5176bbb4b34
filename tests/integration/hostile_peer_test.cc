// Peers that are no workers of the campaign, against a living master: it tells them why, or drops them, keeps
// its memory, and ends with the result of an undisturbed campaign.
// Covers: master/dispatch/wire/connection_watch.cc
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <deque>

#include "proto/protocol.pb.h"
#include "tests/integration/hostile_sockets.h"
#include "tests/integration/scripted_worker.h"
#include "tests/integration/service_driver.h"
#include "tests/integration/zmtp_fuzz.h"
#include "tests/support/sanitizer.h"

namespace gauntlet::testing_support {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr double kMostGrowth = 64.0;  // MiB

class HostilePeer : public testing::Test {
 protected:
  enum Transport { kEncrypted, kPlaintext };

  void SetUp() override {
    campaign_.generations = 3;
    hash_ = UndisturbedHash(campaign_);
  }
  // A master with one worker that takes its time, so that the campaign lasts.
  void Begin(Transport transport, const std::vector<std::string>& limits = {}) {
    std::vector<std::string> argv = limits;
    std::vector<std::string> arguments = MasterArguments(campaign_, dir_);
    if (transport == kPlaintext) arguments = Insecure(std::move(arguments));
    const std::vector<std::string> master = GauntletCommand(arguments);
    argv.insert(argv.end(), master.begin(), master.end());
    master_ = std::make_unique<Process>(argv);
    worker_ = StartSlowWorker(dir_, 60);
    ASSERT_TRUE(RunsDone(dir_, 2)) << master_->Err();
    const std::string endpoint = StatusOf(dir_).at("master").at("endpoints")[0];
    port_ = std::stoi(endpoint.substr(endpoint.rfind(':') + 1));
    memory_ = ResidentMebibytes(master_->pid());
  }
  double Growth() const { return ResidentMebibytes(master_->pid()) - memory_; }
  void ExpectTheUndisturbedResult() {
    const ProcessResult result = master_->Wait();
    EXPECT_EQ(result.exit_code, 0) << result.err << MasterLog(dir_);
    EXPECT_EQ(StateHash(dir_), hash_);
    EXPECT_EQ(worker_->Wait().exit_code, 0) << worker_->Err();
  }

  TemporaryDirectory scratch_;
  std::string dir_ = scratch_ / "c";
  SmallCampaign campaign_;
  std::string hash_;
  std::unique_ptr<Process> master_;
  std::unique_ptr<Process> worker_;
  int port_ = 0;
  double memory_ = 0.0;
};

TEST_F(HostilePeer, AWorkerThatDiffersIsToldInWhatAndGetsNothing) {
  Begin(kEncrypted);
  const auto refusal = [this](const std::function<void(gauntlet::v1::Hello&)>& change) {
    ScriptedWorker peer(dir_, 0x666);
    EXPECT_TRUE(peer.Connect());
    gauntlet::v1::Envelope envelope;
    gauntlet::v1::Hello& hello = *envelope.mutable_hello();
    hello.set_protocol_version(proto::kProtocolVersion);
    hello.set_campaign_id(peer.access().campaign_id);
    hello.set_instance_id(peer.hello().instance_id);
    hello.set_software_version(peer.hello().software_version);
    for (const auto& [controller, hash] : peer.hello().golden_hashes) {
      gauntlet::v1::GoldenHash& golden = *hello.add_golden_hashes();
      golden.set_controller(controller);
      golden.set_hash(hash);
    }
    hello.set_slots(1);
    change(hello);
    peer.SayBytes(envelope.SerializeAsString());
    const auto refused = peer.HearA<proto::Refused>();
    EXPECT_FALSE(peer.HearA<proto::Lease>(milliseconds(50)));
    return refused ? refused->reason : "";
  };
  EXPECT_THAT(refusal([](auto& hello) { hello.set_protocol_version(99); }),
              HasSubstr("speaks protocol version 99, this master speaks 1"));
  EXPECT_THAT(refusal([](auto& hello) { hello.set_campaign_id("stolen"); }), HasSubstr("campaign 'stolen'"));
  EXPECT_EQ(refusal([](auto& hello) {
              for (auto& golden : *hello.mutable_golden_hashes()) golden.set_hash(1);
            }),
            "this worker's golden hash of controller 'flocking' is 0000000000000001, the campaign's is "
            "f13104f5ca97be06: the same runs end differently on its machine, so its results cannot be mixed "
            "with the others");
  EXPECT_EQ(refusal([](auto& hello) { hello.clear_golden_hashes(); }),
            "this worker was built without the controller 'flocking', which the campaign uses");
  ExpectTheUndisturbedResult();
  EXPECT_THAT(MasterLog(dir_), HasSubstr("worker-refused"));
}

// Words of 302 bytes, of which the end is shown: it begins inside a character. And a terminal's command.
TEST_F(HostilePeer, WordsThatNobodyCanReadAreShownToPeopleAndEndNothing) {
  campaign_.generations = 5;
  hash_ = UndisturbedHash(campaign_);
  Begin(kEncrypted);
  std::string words = "\x1b";
  for (int i = 0; i < 150; ++i) words += "\u00e9";
  words += "x";
  ScriptedWorker admitted(dir_, 0x666);
  admitted.hello().process.host = words;
  admitted.hello().allocation = words;
  ASSERT_TRUE(admitted.Join());
  EXPECT_TRUE(
      StatusBecomes(dir_, [](const nlohmann::json& status) { return status.value("workers", 0) == 2; }));
  EXPECT_THAT(Gauntlet({"status", dir_}).out, testing::Not(HasSubstr("\x1b")));
  admitted.Say(proto::Goodbye{words});
  ScriptedWorker refused(dir_, 0x667);
  ASSERT_TRUE(refused.Connect());
  refused.hello().campaign_id = words;
  refused.Say(refused.hello());
  EXPECT_TRUE(refused.HearA<proto::Refused>());
  ExpectTheUndisturbedResult();
  EXPECT_THAT(MasterLog(dir_), testing::Not(HasSubstr("\x1b")));
}

// Over plaintext nobody has proven to know anything, and so learns nothing.
TEST_F(HostilePeer, AStrangerIsRefusedWithoutAWordOfTheCampaign) {
  Begin(kPlaintext);
  ScriptedWorker peer(dir_, 0x666);
  ASSERT_TRUE(peer.Connect());
  peer.hello().campaign_id = "guessed";
  peer.Say(peer.hello());
  const auto refused = peer.HearA<proto::Refused>();
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->reason, "this worker belongs to campaign 'guessed', this master serves another");

  ExpectTheUndisturbedResult();
  EXPECT_THAT(MasterLog(dir_), HasSubstr("this master serves campaign '" + peer.access().campaign_id + "'"));
}

// Each sort of connection that costs its owner nothing: silent, half a greeting, a whole one, a whole
// handshake, a handshake and garbage.
TEST_F(HostilePeer, TenThousandConnectionsAndHalfGreetings) {
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  const auto connections = static_cast<std::size_t>(std::min<rlim_t>(files.rlim_max, 10'200) - 200);
  files.rlim_cur = std::min<rlim_t>(files.rlim_max, 10'200);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &files), 0);
  campaign_.generations = 20;
  hash_ = UndisturbedHash(campaign_);
  Begin(kEncrypted);
  const std::string handshake = ZmtpHandshake();
  const std::string beginnings[] = {"", handshake.substr(0, 7), handshake.substr(0, 64), handshake,
                                    handshake + std::string("\0\x05hello", 7)};
  std::vector<HostileSocket> sockets;
  for (std::size_t i = 0; i < connections; ++i) {
    sockets.emplace_back(port_);
    sockets.back().Send(beginnings[i % std::size(beginnings)]);
  }
  std::size_t connected = 0;
  for (const HostileSocket& socket : sockets) connected += socket.connected() ? 1 : 0;
  const double growth = Growth();
  // The master is still there for its worker, and for a second one.
  const int done = StatusOf(dir_).at("runs_done");
  EXPECT_TRUE(RunsDone(dir_, done + 2)) << MasterLog(dir_);
  const std::unique_ptr<Process> second = StartSlowWorker(dir_, 60);
  EXPECT_TRUE(LogBecomes(dir_, fmt::format("(pid {}, slots 1) joined", second->pid())));
  fmt::print("{} connections: {:.1f} MiB of {:.1f} more\n", connected, growth, memory_);
  EXPECT_GT(connected, connections / 2);
  // A sanitizer's shadow of 10,000 connections says nothing about the master's own memory.
  if (!kSanitized) {
    EXPECT_LT(growth, kMostGrowth + 0.015 * static_cast<double>(connections));
  }
  ExpectTheUndisturbedResult();
}

// Whole handshakes, and then for ever nonsense: nothing in ZeroMQ can drop a single peer that answers. They
// cost the master little, and nobody else anything.
TEST_F(HostilePeer, AThousandPeersThatTalkNonsenseForEver) {
  campaign_.generations = 10;
  hash_ = UndisturbedHash(campaign_);
  Begin(kPlaintext);
  const std::string nonsense("\0\x05hello", 7);
  std::vector<HostileSocket> sockets;
  for (int i = 0; i < 1000; ++i) {
    sockets.emplace_back(port_);
    sockets.back().Send(ZmtpHandshake() + nonsense);
  }
  const std::unique_ptr<Process> second = StartSlowWorker(dir_, 60);
  int rounds = 0;
  for (; master_->Running(); ++rounds) {
    for (HostileSocket& socket : sockets) socket.Send(nonsense);
    if (rounds == 3) {
      EXPECT_LT(Growth(), kMostGrowth);
    }
  }
  EXPECT_GT(rounds, 3);
  ExpectTheUndisturbedResult();
  EXPECT_EQ(second->Wait().exit_code, 0) << second->Err();
  EXPECT_THAT(MasterLog(dir_), testing::Not(HasSubstr("worker-lost")));
}

// The long form is a LongDrill.
TEST_F(HostilePeer, RandomConversationsChangeNothing) {
  for (const bool encrypted : {false, true}) {
    SCOPED_TRACE(encrypted ? "CURVE" : "plaintext");
    campaign_.generations = 5;
    hash_ = UndisturbedHash(campaign_);
    Begin(encrypted ? kEncrypted : kPlaintext);
    double growth = 0.0;
    const ZmtpFuzzReport report = FuzzPort(port_, encrypted, 1, [&] {
      const bool runs = master_->Running();
      if (runs) growth = std::max(growth, Growth());
      return runs;
    });
    fmt::print("{} connections, {} bytes, {:.1f} MiB of {:.1f} more\n", report.connections, report.bytes,
               growth, memory_);
    EXPECT_GT(report.connections, 100U);
    EXPECT_LT(growth, kMostGrowth);
    ExpectTheUndisturbedResult();
    dir_ = scratch_ / "encrypted";
  }
}

// More connections than the master may have files open: it must not lose the files it needs itself.
TEST_F(HostilePeer, MoreConnectionsThanOpenFilesAreAllowed) {
  campaign_.generations = 16;
  hash_ = UndisturbedHash(campaign_);
  Begin(kEncrypted, {"/usr/bin/prlimit", "--nofile=128:128"});
  std::deque<HostileSocket> sockets;
  const auto connect = [&] {
    sockets.emplace_back(port_);
    sockets.back().Send(ZmtpHandshake().substr(0, sockets.size() % 64));  // half a greeting lasts longest
  };
  for (int i = 0; i < 400; ++i) connect();
  // Nor do they keep a worker from being admitted, while ever more of them come.
  const std::unique_ptr<Process> second = StartSlowWorker(dir_, 60);
  const std::string joined = fmt::format("(pid {}, slots 1) joined", second->pid());
  EXPECT_TRUE(Eventually(
      [&] {
        connect();
        if (sockets.size() > 400) sockets.pop_front();
        return MasterLog(dir_).find(joined) != std::string::npos;
      },
      kPatience));
  ExpectTheUndisturbedResult();
}

}  // namespace
}  // namespace gauntlet::testing_support
