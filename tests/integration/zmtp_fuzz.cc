#include "tests/integration/zmtp_fuzz.h"

#include <deque>
#include <random>
#include <string>

#include "proto/protocol.pb.h"
#include "tests/integration/hostile_sockets.h"

namespace gauntlet::testing_support {
namespace {

constexpr std::size_t kOpenConnections = 100;  // the oldest is closed

class Conversations {
 public:
  Conversations(bool encrypted, std::uint64_t seed) : encrypted_(encrypted), random_(seed) {}

  std::string Next() {
    std::string bytes = encrypted_ ? CurveBeginning() : ZmtpHandshake();
    for (std::size_t frames = Below(4); frames > 0; --frames) bytes += Frame();
    const std::size_t whole = Below(2) == 0 ? 0 : Below(bytes.size());
    for (std::size_t damages = Below(5); damages > 0; --damages) Damage(bytes, std::min(whole, bytes.size()));
    return bytes;
  }

 private:
  std::size_t Below(std::size_t bound) { return bound == 0 ? 0 : random_() % bound; }
  std::string RandomBytes(std::size_t size) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random_());
    return bytes;
  }

  std::string RandomText(std::size_t size) {
    std::string text(size, 'a');
    for (char& letter : text) letter = static_cast<char>('a' + Below(16));
    return text;
  }

  // https://rfc.zeromq.org/spec/26/: a HELLO of the right form whose signature cannot be right.
  std::string CurveBeginning() {
    std::string bytes = ZmtpHandshake().substr(0, 64);
    bytes.replace(12, 5, "CURVE");
    const std::string hello =
        std::string("\x05HELLO\x01\0", 8) + std::string(72, '\0') + RandomBytes(32 + 8 + 80);
    return bytes + '\x04' + static_cast<char>(hello.size()) + hello;
  }

  std::string Message() {
    gauntlet::v1::Envelope envelope;
    switch (Below(4)) {
      case 0: {
        gauntlet::v1::Hello& hello = *envelope.mutable_hello();
        hello.set_protocol_version(1);
        hello.set_campaign_id(RandomText(32));
        hello.set_instance_id(random_());
        hello.set_pid(static_cast<std::int64_t>(random_()));
        hello.set_boot_id(RandomText(36));
        hello.add_held_leases(random_());
        break;
      }
      case 1:
        envelope.mutable_lease_result()->set_fence((1ULL << 32) + Below(100));
        envelope.mutable_lease_result()->set_run_id(1 + Below(100));
        envelope.mutable_lease_result()->set_result(RandomBytes(Below(2000)));
        break;
      case 2:
        for (std::size_t i = Below(100); i > 0; --i) envelope.mutable_heartbeat()->add_held_leases(random_());
        break;
      default:
        return RandomBytes(Below(300));
    }
    return envelope.SerializeAsString();
  }

  // https://rfc.zeromq.org/spec/23/: flags (bit 0 more, 1 long, 2 command), length, body.
  std::string Frame() {
    const std::string body = Message();
    const bool is_long = body.size() > 255 || Below(4) == 0;
    std::string bytes(
        1, static_cast<char>((Below(8) == 0 ? 1 : 0) | (is_long ? 2 : 0) | (Below(8) == 0 ? 4 : 0)));
    for (int shift = is_long ? 56 : 0; shift >= 0; shift -= 8)
      bytes += static_cast<char>(static_cast<std::uint64_t>(body.size()) >> shift);
    return bytes + body;
  }

  void Damage(std::string& bytes, std::size_t from) {
    const std::size_t at = from + Below(bytes.size() - from);
    switch (Below(5)) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << Below(8)));
        break;
      case 1:
        bytes.resize(at);
        break;
      case 2:
        bytes.insert(at, RandomBytes(1 + Below(64)));
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, Below(100)));
        break;
      default:
        bytes.replace(at, std::min<std::size_t>(8, bytes.size() - at), std::string(8, '\xff'));
    }
  }

  bool encrypted_;
  std::mt19937_64 random_;
};

}  // namespace

ZmtpFuzzReport FuzzPort(int port, bool encrypted, std::uint64_t seed, const std::function<bool()>& go_on) {
  Conversations conversations(encrypted, seed);
  std::deque<HostileSocket> open;
  ZmtpFuzzReport report;
  while (go_on()) {
    const std::string bytes = conversations.Next();
    open.emplace_back(port);
    if (open.back().connected()) {
      ++report.connections;
      report.bytes += bytes.size();
      open.back().Send(bytes);
    }
    if (open.size() > kOpenConnections) open.pop_front();
  }
  return report;
}

}  // namespace gauntlet::testing_support
