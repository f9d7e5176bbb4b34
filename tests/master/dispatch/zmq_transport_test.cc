// Real sockets on the loopback interface; every wait ends with its condition or at a deadline.
// Covers: master/dispatch/wire/curve_keys.cc
#include "master/dispatch/wire/zmq_transport.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <thread>
#include <zmq.hpp>

#include "proto/access_file.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::size_t kLimit = 1U << 20;

class ZmqTransportTest : public testing::Test {
 protected:
  ZmqTransportTest() {
    ZmqTransportOptions options;
    options.max_message_bytes = kLimit;
    options.peer_queue = 10;
    Result<std::unique_ptr<ZmqTransport>> bound = ZmqTransport::Bind(options);
    EXPECT_TRUE(bound.ok()) << bound.error().message;
    transport_ = *std::move(bound);
  }

  zmq::socket_t Connect() {
    zmq::socket_t dealer(context_, zmq::socket_type::dealer);
    dealer.set(zmq::sockopt::linger, 0);
    dealer.set(zmq::sockopt::rcvtimeo, 10000);
    dealer.set(zmq::sockopt::rcvhwm, 10);
    dealer.connect(transport_->endpoint());
    return dealer;
  }

  // A TCP connection that speaks something else.
  int ConnectRaw() const {
    const std::string& endpoint = transport_->endpoint();
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port =
        htons(static_cast<std::uint16_t>(std::atoi(endpoint.substr(endpoint.rfind(':') + 1).c_str())));
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    EXPECT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return fd;
  }

  bool Eventually(const std::function<bool()>& condition) {
    const auto deadline = std::chrono::steady_clock::now() + seconds(10);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      transport_->Wait(milliseconds(20), {});
      transport_->Receive(100, received_);
    }
    return true;
  }

  std::unique_ptr<ZmqTransport> transport_;
  zmq::context_t context_{1};
  std::vector<PeerMessage> received_;
};

TEST_F(ZmqTransportTest, SaysWhereItListens) {
  EXPECT_THAT(transport_->endpoint(), testing::MatchesRegex("tcp://127\\.0\\.0\\.1:[0-9]+"));
}

TEST_F(ZmqTransportTest, CarriesMessagesBothWays) {
  zmq::socket_t dealer = Connect();
  const std::string hello("hello \0 world", 13);
  dealer.send(zmq::buffer(hello), zmq::send_flags::none);
  ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
  EXPECT_EQ(received_[0].bytes, hello);
  EXPECT_EQ(transport_->Send(received_[0].peer, "answer"), SendOutcome::kSent);
  zmq::message_t answer;
  ASSERT_TRUE(dealer.recv(answer).has_value());
  EXPECT_EQ(answer.to_string(), "answer");
  EXPECT_FALSE(answer.more());
}

TEST_F(ZmqTransportTest, ReceivesNoMoreThanAskedFor) {
  zmq::socket_t dealer = Connect();
  for (int i = 0; i < 5; ++i) dealer.send(zmq::buffer(std::to_string(i)), zmq::send_flags::none);
  std::vector<PeerMessage> messages;
  const auto deadline = std::chrono::steady_clock::now() + seconds(10);
  while (messages.size() < 2 && std::chrono::steady_clock::now() < deadline) {
    transport_->Wait(milliseconds(20), {});
    transport_->Receive(2 - messages.size(), messages);
  }
  EXPECT_THAT(messages, SizeIs(2));
  ASSERT_TRUE(Eventually([this] { return received_.size() == 3; }));
  EXPECT_EQ(received_[2].bytes, "4");
}

TEST(IpcTransportTest, NobodyIsPushedFromHisSocketButADeadOnesIsTakenOver) {
  const testing_support::TemporaryDirectory scratch;
  ZmqTransportOptions options;
  options.endpoint = "ipc://" + scratch / "socket";
  Result<std::unique_ptr<ZmqTransport>> first = ZmqTransport::Bind(options);
  ASSERT_TRUE(first.ok()) << first.error().message;
  const Result<std::unique_ptr<ZmqTransport>> second = ZmqTransport::Bind(options);
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().kind, ErrorKind::kInUse);
  EXPECT_THAT(second.error().message, HasSubstr("another process does"));
  // What a killed process leaves: a socket file without a listener.
  const std::string left = scratch / "left";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  left.copy(address.sun_path, sizeof address.sun_path - 1);
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(fd);
  options.endpoint = "ipc://" + left;
  const Result<std::unique_ptr<ZmqTransport>> successor = ZmqTransport::Bind(options);
  EXPECT_TRUE(successor.ok()) << successor.error().message;
}

// A transport with keys, and dealers that try to get in.
class CurveTransportTest : public ZmqTransportTest {
 protected:
  void SetUp() override {
    ZmqTransportOptions options;
    options.curve = CampaignKeys{server_, known_};
    transport_.reset();
    Result<std::unique_ptr<ZmqTransport>> transport = ZmqTransport::Bind(options);
    ASSERT_TRUE(transport.ok()) << transport.error().message;
    transport_ = *std::move(transport);
  }
  zmq::socket_t ConnectWith(const CurveKeyPair& own, const std::string& server_key) {
    zmq::socket_t dealer(context_, zmq::socket_type::dealer);
    dealer.set(zmq::sockopt::linger, 0);
    dealer.set(zmq::sockopt::curve_serverkey, server_key);
    dealer.set(zmq::sockopt::curve_publickey, own.public_key);
    dealer.set(zmq::sockopt::curve_secretkey, own.secret_key);
    dealer.connect(transport_->endpoint());
    return dealer;
  }

  const CurveKeyPair server_ = NewCurveKeyPair();
  const CurveKeyPair known_ = NewCurveKeyPair();
};

TEST_F(CurveTransportTest, AKnownKeyIsLetIn) {
  zmq::socket_t dealer = ConnectWith(known_, server_.public_key);
  dealer.send(zmq::str_buffer("hello"), zmq::send_flags::none);
  ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
  EXPECT_EQ(received_[0].bytes, "hello");
  EXPECT_EQ(transport_->Send(received_[0].peer, "answer"), SendOutcome::kSent);
}

TEST_F(CurveTransportTest, UnknownKeysAnotherServersKeyAndPlaintextAreKeptOutAndCounted) {
  const auto tries = [this](const char* what,
                            std::uint64_t TransportRejections::*counter = &TransportRejections::handshakes) {
    const std::uint64_t before = transport_->Rejections().*counter;
    EXPECT_TRUE(Eventually([&] { return transport_->Rejections().*counter > before; })) << what;
  };
  {
    zmq::socket_t stranger = ConnectWith(NewCurveKeyPair(), server_.public_key);
    stranger.send(zmq::str_buffer("stranger"), zmq::send_flags::none);
    tries("unknown key", &TransportRejections::keys);
  }
  {
    zmq::socket_t misled = ConnectWith(known_, NewCurveKeyPair().public_key);
    misled.send(zmq::str_buffer("misled"), zmq::send_flags::none);
    tries("another server's key");
  }
  {
    zmq::socket_t plain = Connect();
    plain.send(zmq::str_buffer("plain"), zmq::send_flags::none);
    tries("plaintext");
  }
  zmq::socket_t dealer = ConnectWith(known_, server_.public_key);
  dealer.send(zmq::str_buffer("known"), zmq::send_flags::none);
  ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
  ASSERT_THAT(received_, SizeIs(1));
  EXPECT_EQ(received_[0].bytes, "known");
}

TEST(CurveKeysTest, KeysAreFreshAndHaveTheirForm) {
  const CurveKeyPair keys = NewCurveKeyPair();
  EXPECT_TRUE(proto::IsCurveKey(keys.public_key));
  EXPECT_TRUE(proto::IsCurveKey(keys.secret_key));
  EXPECT_NE(NewCurveKeyPair(), keys);
  for (const char* wrong :
       {"", "short", "0123456789012345678901234567890123456789x", "\"123456789012345678901234567890123456789",
        "########################################"}) {
    EXPECT_FALSE(proto::IsCurveKey(wrong)) << wrong;
  }
}

TEST_F(ZmqTransportTest, UnknownPeersAreUnreachable) {
  EXPECT_EQ(transport_->Send("nobody", "message"), SendOutcome::kUnreachable);
  EXPECT_EQ(transport_->Send("", "message"), SendOutcome::kUnreachable);
}

TEST_F(ZmqTransportTest, APeerThatDisconnectedIsUnreachable) {
  zmq::socket_t dealer = Connect();
  dealer.send(zmq::str_buffer("hello"), zmq::send_flags::none);
  ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
  dealer.close();
  EXPECT_TRUE(Eventually(
      [this] { return transport_->Send(received_[0].peer, "are you there") == SendOutcome::kUnreachable; }));
}

TEST_F(ZmqTransportTest, APeerThatDoesNotReadFillsABoundedQueue) {
  zmq::socket_t dealer = Connect();
  dealer.send(zmq::str_buffer("hello"), zmq::send_flags::none);
  ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
  const std::string message(500000, 'x');
  int sent = 0;
  while (sent < 1000 && transport_->Send(received_[0].peer, message) == SendOutcome::kSent) ++sent;
  EXPECT_LT(sent, 1000) << "nothing stopped the flood";
  EXPECT_EQ(transport_->Send(received_[0].peer, message), SendOutcome::kFull);
}

TEST_F(ZmqTransportTest, MessagesOfSeveralFramesAreDroppedAndCounted) {
  zmq::socket_t dealer = Connect();
  dealer.send(zmq::str_buffer("one"), zmq::send_flags::sndmore);
  dealer.send(zmq::str_buffer("two"), zmq::send_flags::sndmore);
  dealer.send(zmq::str_buffer("three"), zmq::send_flags::none);
  dealer.send(zmq::str_buffer("good"), zmq::send_flags::none);
  ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
  EXPECT_THAT(received_, SizeIs(1));
  EXPECT_EQ(received_[0].bytes, "good");
  EXPECT_EQ(transport_->Rejections().malformed, 1U);
}

TEST_F(ZmqTransportTest, ATooLongMessageIsDroppedAndCounted) {
  zmq::socket_t dealer = Connect();
  dealer.send(zmq::buffer(std::string(kLimit + 1, 'x')), zmq::send_flags::none);
  dealer.send(zmq::buffer(std::string(kLimit, 'y')), zmq::send_flags::none);
  ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
  EXPECT_EQ(received_[0].bytes.front(), 'y');
  EXPECT_EQ(transport_->Rejections().oversized, 1U);
}

TEST_F(ZmqTransportTest, TakesOnlySoManyLongMessagesAtOnce) {
  zmq::socket_t dealer = Connect();
  for (int i = 0; i < 10; ++i) dealer.send(zmq::message_t(kLimit), zmq::send_flags::none);
  const auto deadline = std::chrono::steady_clock::now() + seconds(10);
  std::size_t most = 0;
  std::size_t all = 0;
  while (all < 10 && std::chrono::steady_clock::now() < deadline) {
    transport_->Wait(milliseconds(200), {});
    received_.clear();
    transport_->Receive(100, received_);
    most = std::max(most, received_.size());
    all += received_.size();
  }
  EXPECT_EQ(all, 10U);
  EXPECT_LE(most, 4U);
}

TEST_F(ZmqTransportTest, AMuchTooLongMessageClosesItsConnectionOnly) {
  zmq::socket_t good = Connect();
  good.send(zmq::str_buffer("hello"), zmq::send_flags::none);
  ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
  const PeerId good_peer = received_[0].peer;
  received_.clear();
  {
    zmq::socket_t flooder = Connect();
    flooder.send(zmq::str_buffer("hello"), zmq::send_flags::none);
    ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
    const PeerId flooding_peer = received_[0].peer;
    received_.clear();
    flooder.send(zmq::buffer(std::string(4 * kLimit, 'x')), zmq::send_flags::none);
    EXPECT_TRUE(Eventually(
        [&] { return transport_->Send(flooding_peer, "still there") == SendOutcome::kUnreachable; }));
  }
  EXPECT_THAT(received_, IsEmpty());
  EXPECT_EQ(transport_->Send(good_peer, "answer"), SendOutcome::kSent);
  zmq::message_t answer;
  EXPECT_TRUE(good.recv(answer).has_value());
}

TEST_F(ZmqTransportTest, GarbageBytesAreCountedAndDisturbNobody) {
  zmq::socket_t good = Connect();
  for (const std::string& garbage :
       {std::string("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"), std::string(5000, '\xff'),
        std::string("\xff\0\0\0\0\0\0\0\x01\x7f\x03\0garbage-mechanism", 30)}) {
    const std::uint64_t before = transport_->Rejections().handshakes;
    const int fd = ConnectRaw();
    EXPECT_GT(send(fd, garbage.data(), garbage.size(), MSG_NOSIGNAL), 0);
    shutdown(fd, SHUT_WR);
    EXPECT_TRUE(Eventually([&] { return transport_->Rejections().handshakes > before; })) << garbage;
    close(fd);
  }
  good.send(zmq::str_buffer("hello"), zmq::send_flags::none);
  ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
  EXPECT_THAT(received_, SizeIs(1));
  EXPECT_EQ(received_[0].bytes, "hello");
}

// A greeting of ZMTP 3.0 and READY of a DEALER: from then on nothing limits how long a connection lasts.
std::string WholeHandshake(char minor_version) {
  std::string bytes = "\xff" + std::string(8, '\0') + "\x7f\x03" + std::string(1, minor_version) + "NULL";
  bytes += std::string(64 - bytes.size(), '\0');
  const std::string ready = std::string("\x05READY\x0bSocket-Type\0\0\0\x06", 22) + "DEALER";
  return bytes + "\x04" + static_cast<char>(ready.size()) + ready;
}

// ZeroMQ limits each part alone. A worker beside it that sends as much in whole messages is left alone.
TEST_F(ZmqTransportTest, AMessageThatDoesNotEndClosesItsConnectionOnly) {
  zmq::socket_t good = Connect();
  const int fd = ConnectRaw();
  const std::string handshake = WholeHandshake(0);
  ASSERT_GT(send(fd, handshake.data(), handshake.size(), MSG_NOSIGNAL), 0);
  // The answer is a greeting of 64 bytes and a READY; whoever sends messages before it is thrown out.
  std::string answer(65, '\0');
  ASSERT_EQ(recv(fd, answer.data(), answer.size(), MSG_WAITALL), std::ssize(answer));
  const std::string part = std::string("\x03\0\0\0\0\0\0\x80\0", 9) + std::string(0x8000, 'x');  // and more
  std::size_t at = 0;  // in the part
  std::size_t sent = 0;
  std::size_t whole = 0;
  const bool closed = Eventually([&] {
    if (good.send(zmq::message_t(kLimit / 4), zmq::send_flags::dontwait)) ++whole;
    for (int i = 0; i < 16; ++i) {
      const ssize_t now = send(fd, part.data() + at, part.size() - at, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (now < 0) break;
      sent += static_cast<std::size_t>(now);
      at = (at + static_cast<std::size_t>(now)) % part.size();
    }
    const ssize_t heard = recv(fd, answer.data(), answer.size(), MSG_DONTWAIT);
    return heard == 0 || (heard < 0 && errno != EAGAIN);
  });
  close(fd);
  EXPECT_TRUE(closed) << sent;
  EXPECT_GT(sent, 4 * kLimit);
  EXPECT_EQ(transport_->Rejections().malformed, 1U);
  EXPECT_GT(whole * kLimit / 4, 4 * kLimit) << "as much as the other";
  EXPECT_TRUE(Eventually([&] { return received_.size() == whole; })) << received_.size() << " of " << whole;
}

TEST_F(ZmqTransportTest, AConnectionWithoutASignOfLifeIsClosedButAWorkerThatSaysNothingIsKept) {
  ZmqTransportOptions options;
  options.sign_of_life = milliseconds(150);
  transport_ = *ZmqTransport::Bind(options);
  zmq::socket_t quiet = Connect();
  quiet.send(zmq::str_buffer("hello"), zmq::send_flags::none);
  ASSERT_TRUE(Eventually([this] { return !received_.empty(); }));
  const PeerId quiet_peer = received_[0].peer;

  for (const char minor_version : {'\0', '\1'}) {
    const int fd = ConnectRaw();
    const std::string handshake = WholeHandshake(minor_version);
    ASSERT_EQ(send(fd, handshake.data(), handshake.size(), MSG_NOSIGNAL), std::ssize(handshake));
    const timeval patience{.tv_sec = 0, .tv_usec = 1000};
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    std::string answer(4096, '\0');
    ssize_t got = -1;
    EXPECT_TRUE(Eventually([&] {
      while ((got = recv(fd, answer.data(), answer.size(), 0)) > 0) continue;
      return got == 0 || errno == ECONNRESET;
    })) << "version 3."
        << static_cast<int>(minor_version);
    close(fd);
  }
  EXPECT_EQ(transport_->Send(quiet_peer, "still there"), SendOutcome::kSent);
  zmq::message_t message;
  EXPECT_TRUE(quiet.recv(message).has_value());
  EXPECT_EQ(message.to_string(), "still there");
}

TEST_F(ZmqTransportTest, AnotherThreadWakesItUp) {
  std::thread waker([this] { transport_->WakeUp(); });
  EXPECT_TRUE(transport_->Wait(seconds(30), {}).woken);
  waker.join();
  EXPECT_FALSE(transport_->Wait(milliseconds(0), {}).woken) << "once per call";
}

TEST_F(ZmqTransportTest, WaitsForDescriptorsToo) {
  int pipe_fds[2];
  ASSERT_EQ(pipe(pipe_fds), 0);
  const int fds[] = {pipe_fds[0]};
  EXPECT_THAT(transport_->Wait(milliseconds(0), fds).ready_fds, IsEmpty());
  ASSERT_EQ(write(pipe_fds[1], "x", 1), 1);
  EXPECT_THAT(transport_->Wait(seconds(30), fds).ready_fds, testing::ElementsAre(pipe_fds[0]));
  close(pipe_fds[0]);
  close(pipe_fds[1]);
}

TEST_F(ZmqTransportTest, SaysWhyItCannotListen) {
  ZmqTransportOptions options;
  options.endpoint = transport_->endpoint();
  Result<std::unique_ptr<ZmqTransport>> bound = ZmqTransport::Bind(options);
  ASSERT_FALSE(bound.ok());
  EXPECT_EQ(bound.error().kind, ErrorKind::kInUse);
  EXPECT_EQ(bound.error().message, "cannot listen on '" + options.endpoint +
                                       "': Address already in use (an endpoint looks like "
                                       "tcp://127.0.0.1:5555, or tcp://127.0.0.1:* for any free port)");
  options.endpoint = "nonsense";
  bound = ZmqTransport::Bind(options);
  ASSERT_FALSE(bound.ok());
  EXPECT_EQ(bound.error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(bound.error().message,
            "cannot listen on 'nonsense': Invalid argument (an endpoint looks like tcp://127.0.0.1:5555, or "
            "tcp://127.0.0.1:* for any free port)");
}

}  // namespace
}  // namespace gauntlet
