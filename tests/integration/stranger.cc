#include "tests/integration/stranger.h"

#include <fmt/format.h>
#include <grp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <vector>
#include <zmq.hpp>

#include "proto/access_file.h"
#include "proto/message_codec.h"
#include "tests/integration/campaign_driver.h"
#include "tests/integration/hostile_sockets.h"
#include "worker/golden_hash.h"

namespace gauntlet::testing_support {
namespace {

constexpr uid_t kNobody = 65534;
constexpr std::uint64_t kInstance = 0x666;

// What a stranger knows: all but the keys.
struct Knowledge {
  std::string dir;
  std::string campaign_id;
  std::string endpoint;
  std::string server_public;  // not secret in itself
  proto::GoldenHashes golden_hashes;
  int each = 0;
};

proto::LeaseResult ResultFor(int number) {
  const auto run = static_cast<std::uint64_t>(number % 400 + 1);
  return {.fence = (1ULL << 32) + run - 1, .run_id = run};
}

// The messages of the `number`th connection, of each kind.
std::vector<std::vector<std::string>> Kinds(const Knowledge& known, int number) {
  proto::Hello hello;
  hello.campaign_id = known.campaign_id;
  hello.instance_id = kInstance;
  hello.software_version = GAUNTLET_VERSION;
  hello.slots = 64;
  hello.golden_hashes = known.golden_hashes;
  const std::string greeting = proto::EncodeWorkerMessage(hello);
  proto::LeaseResult crash = ResultFor(number);
  crash.failure = proto::RunnerFailure{proto::FailureKind::kCrashed, 11, 0};
  proto::LeaseResult nonsense = ResultFor(number);
  nonsense.result = "\xff\xff";
  return {{greeting, proto::EncodeWorkerMessage(crash)},
          {proto::EncodeWorkerMessage(crash)},
          {greeting, proto::EncodeWorkerMessage(nonsense)},
          {greeting, proto::EncodeWorkerMessage(proto::Heartbeat{1, {ResultFor(number).fence}})},
          {greeting, proto::EncodeWorkerMessage(proto::Drain{"forged", false})},
          {greeting, proto::EncodeWorkerMessage(proto::Goodbye{"forged"})},
          {std::string(static_cast<std::size_t>(number % 300 + 1), static_cast<char>(number))}};
}

// False when somebody answered with more than a greeting.
bool ForgeInPlaintext(const Knowledge& known) {
  constexpr std::size_t kGreeting = 64;
  const int port = std::stoi(known.endpoint.substr(known.endpoint.rfind(':') + 1));
  for (int i = 0; i < known.each; ++i) {
    for (const std::vector<std::string>& messages : Kinds(known, i)) {
      std::string bytes = ZmtpHandshake();
      for (const std::string& message : messages) bytes += ZmtpMessage(message);
      HostileSocket socket(port);
      socket.Send(bytes);
      if (socket.HearOut().size() > kGreeting) return false;
    }
    HostileSocket(port).Send(std::string(64, static_cast<char>(i)));  // not even a greeting
  }
  return true;
}

// A connection cannot be made anew for each message by a hundred thousand: a few share one. False when
// somebody answered.
bool ForgeWithKeys(const Knowledge& known, const std::string& server_public) {
  constexpr int kOnOneConnection = 50;
  zmq::context_t context(1);
  const std::size_t kinds = Kinds(known, 0).size();
  for (int first = 0; first < known.each; first += kOnOneConnection) {
    char public_key[41];
    char secret_key[41];
    if (zmq_curve_keypair(public_key, secret_key) != 0) return false;
    std::vector<zmq::socket_t> sockets;
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      zmq::socket_t& dealer = sockets.emplace_back(context, zmq::socket_type::dealer);
      dealer.set(zmq::sockopt::linger, 0);
      dealer.set(zmq::sockopt::curve_serverkey, server_public);
      dealer.set(zmq::sockopt::curve_publickey, public_key);
      dealer.set(zmq::sockopt::curve_secretkey, secret_key);
      dealer.connect(known.endpoint);
      for (int i = first; i < std::min(first + kOnOneConnection, known.each); ++i) {
        const std::vector<std::vector<std::string>> messages = Kinds(known, i);
        for (const std::string& message : messages[kind])
          dealer.send(zmq::buffer(message), zmq::send_flags::dontwait);
      }
    }
    // Long enough for a handshake; whoever got through would be welcomed.
    std::vector<zmq::pollitem_t> items;
    for (zmq::socket_t& socket : sockets) items.push_back({socket.handle(), 0, ZMQ_POLLIN, 0});
    if (zmq::poll(items, std::chrono::milliseconds(20)) > 0) return false;
  }
  return true;
}

std::string Forge(const Knowledge& known) {
  if (setgroups(0, nullptr) != 0 || setgid(kNobody) != 0 || setuid(kNobody) != 0) return "cannot be nobody";
  if (!std::ifstream(known.dir + "/status.json"))
    return "cannot reach the directory: the drill shows nothing";
  for (const char* secret : {"/access.json", "/master.key"}) {
    if (std::ifstream(known.dir + secret)) return fmt::format("can read {}", secret);
  }
  if (!ForgeInPlaintext(known)) return "was answered in plaintext";
  char other_public[41];
  char other_secret[41];
  if (zmq_curve_keypair(other_public, other_secret) != 0) return "cannot make keys";
  if (!ForgeWithKeys(known, known.server_public)) return "was answered with unknown keys";
  if (!ForgeWithKeys(known, other_public)) return "was answered with a wrong server key";
  return "";
}

}  // namespace

bool CanBeAnotherUser() {
  return geteuid() == 0;
}

std::string ForgeAsAnotherUser(const std::string& dir, int each) {
  const Result<proto::Access> access = proto::ReadAccess(dir + "/access.json");
  if (!access) return access.error().message;
  Knowledge known{.dir = dir,
                  .campaign_id = access->campaign_id,
                  .endpoint = access->endpoints.front(),
                  .server_public = access->curve ? access->curve->server_public : std::string(40, '0'),
                  .golden_hashes = worker::GoldenHashes(),
                  .each = each};
  int answer[2];
  if (pipe(answer) != 0) return "no pipe";
  const pid_t child = fork();
  if (child < 0) return "no process";
  if (child == 0) {
    const std::string outcome = Forge(known);
    const auto written = write(answer[1], outcome.data(), outcome.size());
    _exit(written == std::ssize(outcome) ? 0 : 1);
  }
  close(answer[1]);
  std::string outcome;
  char part[256];
  for (ssize_t size = 0; (size = read(answer[0], part, sizeof part)) > 0;)
    outcome.append(part, static_cast<std::size_t>(size));
  close(answer[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return status == 0 ? outcome : fmt::format("ended with {}", status);
}

}  // namespace gauntlet::testing_support
