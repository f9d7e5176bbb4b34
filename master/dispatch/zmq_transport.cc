#include "master/dispatch/zmq_transport.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <zmq.hpp>

#include "base/thread_sanitizer.h"
#include "master/dispatch/connection_watch.h"

namespace gauntlet::master {
namespace {

// The connection is closed only beyond the limit of a message, so that a slightly too long one can be
// counted.
constexpr std::size_t kConnectionMargin = 1U << 20;
// Messages of the longest sort that Receive takes at once: whoever sends only such must not keep the master
// from everybody else.
constexpr std::size_t kLongestAtOnce = 4;
// A message of several parts is none of ours. Beyond so many of the longest messages its connection is closed
// although it has not ended; looked for so often when nothing waits to be received, and less often when
// something always does.
constexpr std::uint64_t kLongestUnended = 4;
constexpr std::chrono::milliseconds kWatchEvery{250};
constexpr std::chrono::milliseconds kWatchAtLeast{2000};
constexpr int kLingerMilliseconds = 100;  // for the last messages to leave
constexpr const char* kMonitorAddress = "inproc://gauntlet-transport-monitor";
constexpr int kMonitoredEvents = ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL |
                                 ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;

// libzmq would remove the socket file of whoever listens on an ipc endpoint, and listen there itself.
bool SomebodyListens(const std::string& endpoint) {
  constexpr std::string_view kScheme = "ipc://";
  sockaddr_un address{};
  if (!endpoint.starts_with(kScheme) || endpoint.size() - kScheme.size() >= sizeof address.sun_path) {
    return false;
  }
  address.sun_family = AF_UNIX;
  endpoint.copy(address.sun_path, sizeof address.sun_path - 1, kScheme.size());
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return false;
  // EAGAIN: somebody does, and has a full queue.
  const bool answered =
      connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 || errno == EAGAIN;
  close(fd);
  return answered;
}

// Of "tcp://ADDRESS:PORT"; 0 for others.
std::uint16_t PortOf(std::string_view endpoint) {
  std::uint16_t port = 0;
  if (!endpoint.starts_with("tcp://")) return port;
  endpoint.remove_prefix(endpoint.rfind(':') + 1);
  std::from_chars(endpoint.data(), endpoint.data() + endpoint.size(), port);
  return port;
}

}  // namespace

struct ZmqTransport::Sockets {
  zmq::context_t context{1};
  std::optional<zmq::socket_t> zap;  // asked by libzmq about every key that connects
  zmq::socket_t router{context, zmq::socket_type::router};
  zmq::socket_t monitor{context, zmq::socket_type::pair};
  int wake_up = -1;
  int zap_fd = -1;                 // -1: no keys, nobody asks
  std::set<std::string> admitted;  // public keys, 32 bytes
  std::size_t max_message_bytes = 0;
  std::string endpoint;
  TransportRejections rejections;
  int router_fd = -1;
  int monitor_fd = -1;
  std::vector<pollfd> poll_items;
  std::optional<ConnectionWatch> watch;  // none: not of TCP
  std::chrono::steady_clock::time_point watched = std::chrono::steady_clock::now();

  void NoteWhole(zmq::message_t& last_part) {
    if (watch) watch->Completed(zmq_msg_get(last_part.handle(), ZMQ_SRCFD));
  }
  void WatchConnections(std::chrono::milliseconds every) {
    if (!watch) return;
    const auto now = std::chrono::steady_clock::now();
    if (now < watched + every) return;
    watched = now;
    rejections.malformed += static_cast<std::uint64_t>(watch->Check());
  }

  void UseCurve(const CurveServer& curve) {
    for (const std::string& key : curve.admitted_keys) {
      std::string bytes(32, '\0');
      if (zmq_z85_decode(reinterpret_cast<std::uint8_t*>(bytes.data()), key.c_str()) != nullptr) {
        admitted.insert(std::move(bytes));
      }
    }
    zap.emplace(context, zmq::socket_type::rep);
    zap->set(zmq::sockopt::linger, 0);
    zap->bind("inproc://zeromq.zap.01");  // the address that ZAP (RFC 27) names
    zap_fd = zap->get(zmq::sockopt::fd);
    AnswerZap();
    router.set(zmq::sockopt::curve_server, true);
    router.set(zmq::sockopt::curve_secretkey, curve.keys.secret_key);
    router.set(zmq::sockopt::zap_domain, "gauntlet");
  }

  // ZAP 1.0 (RFC 27): version, request id, domain, address, identity, mechanism, credentials.
  void AnswerZap() {
    std::vector<std::string> request;
    zmq::message_t frame;
    while (zap->recv(frame, zmq::recv_flags::dontwait)) {
      request.assign(1, frame.to_string());
      while (frame.more() && zap->recv(frame, zmq::recv_flags::dontwait))
        request.push_back(frame.to_string());
      const bool known = request.size() == 7 && request[5] == "CURVE" && admitted.contains(request[6]);
      const std::string id = request.size() > 1 ? request[1] : "";
      const std::array<std::string, 6> reply{"1.0", id, known ? "200" : "400", known ? "OK" : "unknown key",
                                             "",    ""};
      for (std::size_t i = 0; i < reply.size(); ++i) {
        const bool last = i + 1 == reply.size();
        zap->send(zmq::buffer(reply[i]), last ? zmq::send_flags::none : zmq::send_flags::sndmore);
      }
    }
  }

  // Reads the monitor until it is empty: only then its descriptor announces the next event.
  void CountHandshakes() {
    zmq::message_t event;
    zmq::message_t address;
    while (monitor.recv(event, zmq::recv_flags::dontwait)) {
      std::uint16_t kind = 0;
      if (event.size() >= sizeof kind) std::memcpy(&kind, event.data(), sizeof kind);
      ++(kind == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH ? rejections.keys : rejections.handshakes);
      if (event.more()) (void)monitor.recv(address, zmq::recv_flags::dontwait);
    }
  }

  ~Sockets() {
    if (wake_up >= 0) close(wake_up);
  }
};

ZmqTransport::ZmqTransport(std::unique_ptr<Sockets> sockets) : sockets_(std::move(sockets)) {}
ZmqTransport::~ZmqTransport() = default;

Result<std::unique_ptr<ZmqTransport>> ZmqTransport::Bind(const ZmqTransportOptions& options) {
  if (SomebodyListens(options.endpoint)) {
    return Error{ErrorKind::kInUse,
                 fmt::format("cannot listen on '{}': another process does", options.endpoint)};
  }
  try {
    auto sockets = std::make_unique<Sockets>();
    zmq::socket_t& router = sockets->router;
    router.set(zmq::sockopt::router_mandatory, true);
    router.set(zmq::sockopt::router_handover, true);
    router.set(zmq::sockopt::maxmsgsize,
               static_cast<std::int64_t>(options.max_message_bytes + kConnectionMargin));
    router.set(zmq::sockopt::sndhwm, options.peer_queue);
    router.set(zmq::sockopt::rcvhwm, options.peer_queue);
    router.set(zmq::sockopt::linger, kLingerMilliseconds);
    router.set(zmq::sockopt::backlog, 1024);
    router.set(zmq::sockopt::heartbeat_ivl, static_cast<int>(options.sign_of_life.count()));
    router.set(zmq::sockopt::heartbeat_timeout, static_cast<int>(options.sign_of_life.count()));
    if (zmq_socket_monitor(router.handle(), kMonitorAddress, kMonitoredEvents) != 0) throw zmq::error_t();
    sockets->monitor.set(zmq::sockopt::linger, 0);
    sockets->monitor.connect(kMonitorAddress);
    sockets->CountHandshakes();
    if (options.curve) sockets->UseCurve(*options.curve);
    router.bind(options.endpoint);
    sockets->router_fd = router.get(zmq::sockopt::fd);
    sockets->monitor_fd = sockets->monitor.get(zmq::sockopt::fd);
    sockets->endpoint = router.get(zmq::sockopt::last_endpoint);
    sockets->max_message_bytes = options.max_message_bytes;
    if (const std::uint16_t port = PortOf(sockets->endpoint); port != 0)
      sockets->watch.emplace(port, kLongestUnended * options.max_message_bytes);
    sockets->wake_up = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (sockets->wake_up < 0) {
      return Error{ErrorKind::kIo, fmt::format("cannot make an eventfd: {}", std::strerror(errno))};
    }
    return std::unique_ptr<ZmqTransport>(new ZmqTransport(std::move(sockets)));
  } catch (const zmq::error_t& error) {
    const ErrorKind kind = error.num() == EADDRINUSE ? ErrorKind::kInUse
                           : error.num() == EINVAL || error.num() == EPROTONOSUPPORT || error.num() == ENODEV
                               ? ErrorKind::kInvalidInput
                               : ErrorKind::kIo;
    return Error{kind, fmt::format("cannot listen on '{}': {} (an endpoint looks like tcp://127.0.0.1:5555, "
                                   "or tcp://127.0.0.1:* for any free port)",
                                   options.endpoint, error.what())};
  }
}

const std::string& ZmqTransport::endpoint() const {
  return sockets_->endpoint;
}

SendOutcome ZmqTransport::Send(const PeerId& peer, std::string_view bytes) {
  try {
    zmq::message_t identity(peer.data(), peer.size());
    if (!sockets_->router.send(identity, zmq::send_flags::sndmore | zmq::send_flags::dontwait)) {
      return SendOutcome::kFull;
    }
    zmq::message_t body(bytes.data(), bytes.size());
    return sockets_->router.send(body, zmq::send_flags::dontwait) ? SendOutcome::kSent : SendOutcome::kFull;
  } catch (const zmq::error_t&) {
    return SendOutcome::kUnreachable;
  }
}

void ZmqTransport::Receive(std::size_t limit, std::vector<PeerMessage>& messages) {
  zmq::message_t identity;
  zmq::message_t frame;
  std::size_t bytes = 0;
  for (std::size_t received = 0; received < limit; ++received) {
    if (bytes >= kLongestAtOnce * sockets_->max_message_bytes) break;
    try {
      if (!sockets_->router.recv(identity, zmq::recv_flags::dontwait)) {
        return sockets_->WatchConnections(kWatchEvery);
      }
      if (!identity.more()) {
        ++sockets_->rejections.malformed;
        continue;
      }
      // The parts of one message arrive together.
      if (!sockets_->router.recv(frame, zmq::recv_flags::dontwait)) return;
      if (frame.more()) {
        ++sockets_->rejections.malformed;
        while (frame.more() && sockets_->router.recv(frame, zmq::recv_flags::dontwait)) continue;
        sockets_->NoteWhole(frame);
        continue;
      }
    } catch (const zmq::error_t&) {
      return;  // interrupted by a signal: what is there is received next time
    }
    sockets_->NoteWhole(frame);
    bytes += frame.size();
    if (frame.size() > sockets_->max_message_bytes) {
      ++sockets_->rejections.oversized;
      continue;
    }
    messages.push_back({identity.to_string(), frame.to_string()});
  }
  sockets_->WatchConnections(kWatchAtLeast);
}

// Our own poll over libzmq's descriptors: zmq_poll asks every socket for its state before and after, some ten
// system calls each time. ZMQ_FD says only that something may have changed, so the state is asked before
// sleeping (what was left when Receive stopped is not announced again) and after.
WaitOutcome ZmqTransport::Wait(std::chrono::milliseconds timeout, std::span<const int> fds) {
  WaitOutcome outcome;
  const auto readable = [this] { return (sockets_->router.get(zmq::sockopt::events) & ZMQ_POLLIN) != 0; };
  try {
    outcome.messages = readable();
    std::vector<pollfd>& items = sockets_->poll_items;
    items.clear();
    items.push_back({sockets_->router_fd, POLLIN, 0});
    items.push_back({sockets_->monitor_fd, POLLIN, 0});
    items.push_back({sockets_->wake_up, POLLIN, 0});
    items.push_back({sockets_->zap_fd, POLLIN, 0});
    for (const int fd : fds) items.push_back({fd, POLLIN, 0});
    const int wait = outcome.messages ? 0 : static_cast<int>(timeout.count());
    if (poll(items.data(), items.size(), wait) < 0) {
      outcome.woken = true;
      return outcome;
    }
    if (!outcome.messages && items[0].revents != 0) outcome.messages = readable();
    if (items[1].revents != 0) sockets_->CountHandshakes();
    if (items[2].revents != 0) {
      std::uint64_t count = 0;
      outcome.woken = read(sockets_->wake_up, &count, sizeof count) == sizeof count;
    }
    if (items[3].revents != 0) sockets_->AnswerZap();
    for (std::size_t i = 0; i < fds.size(); ++i) {
      if (items[i + 4].revents != 0) outcome.ready_fds.push_back(fds[i]);
    }
  } catch (const zmq::error_t&) {
    outcome.woken = true;  // interrupted by a signal
  }
  return outcome;
}

void ZmqTransport::WakeUp() {
  const std::uint64_t one = 1;
  // Fails only when the counter is at its maximum: then it is readable anyway.
  [[maybe_unused]] const ssize_t written = write(sockets_->wake_up, &one, sizeof one);
}

TransportRejections ZmqTransport::Rejections() const {
  return sockets_->rejections;
}

}  // namespace gauntlet::master
