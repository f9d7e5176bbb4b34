#include "master/dispatch/zmq_transport.h"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <zmq.hpp>

#include "sim/base/thread_sanitizer.h"

namespace gauntlet::master {
namespace {

// The connection is closed only beyond the limit of a message, so that a slightly too long one can be
// counted.
constexpr std::size_t kConnectionMargin = 1U << 20;
constexpr int kLingerMilliseconds = 100;  // for the last messages to leave
constexpr const char* kMonitorAddress = "inproc://gauntlet-transport-monitor";
constexpr int kMonitoredEvents = ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL |
                                 ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;

}  // namespace

struct ZmqTransport::Sockets {
  zmq::context_t context{1};
  zmq::socket_t router{context, zmq::socket_type::router};
  zmq::socket_t monitor{context, zmq::socket_type::pair};
  int wake_up = -1;
  std::size_t max_message_bytes = 0;
  std::string endpoint;
  TransportRejections rejections;
  std::vector<zmq::pollitem_t> poll_items;

  ~Sockets() {
    if (wake_up >= 0) close(wake_up);
  }
};

ZmqTransport::ZmqTransport(std::unique_ptr<Sockets> sockets) : sockets_(std::move(sockets)) {}
ZmqTransport::~ZmqTransport() = default;

Result<std::unique_ptr<ZmqTransport>> ZmqTransport::Bind(const ZmqTransportOptions& options) {
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
    if (zmq_socket_monitor(router.handle(), kMonitorAddress, kMonitoredEvents) != 0) throw zmq::error_t();
    sockets->monitor.set(zmq::sockopt::linger, 0);
    sockets->monitor.connect(kMonitorAddress);
    router.bind(options.endpoint);
    sockets->endpoint = router.get(zmq::sockopt::last_endpoint);
    sockets->max_message_bytes = options.max_message_bytes;
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
  for (std::size_t received = 0; received < limit; ++received) {
    try {
      if (!sockets_->router.recv(identity, zmq::recv_flags::dontwait)) return;
      if (!identity.more()) {
        ++sockets_->rejections.malformed;
        continue;
      }
      // The parts of one message arrive together.
      if (!sockets_->router.recv(frame, zmq::recv_flags::dontwait)) return;
      if (frame.more()) {
        ++sockets_->rejections.malformed;
        while (frame.more() && sockets_->router.recv(frame, zmq::recv_flags::dontwait)) continue;
        continue;
      }
    } catch (const zmq::error_t&) {
      return;  // interrupted by a signal: what is there is received next time
    }
    if (frame.size() > sockets_->max_message_bytes) {
      ++sockets_->rejections.oversized;
      continue;
    }
    messages.push_back({identity.to_string(), frame.to_string()});
  }
}

WaitOutcome ZmqTransport::Wait(std::chrono::milliseconds timeout, std::span<const int> fds) {
  WaitOutcome outcome;
  std::vector<zmq::pollitem_t>& items = sockets_->poll_items;
  items.clear();
  items.push_back({sockets_->router.handle(), 0, ZMQ_POLLIN, 0});
  items.push_back({sockets_->monitor.handle(), 0, ZMQ_POLLIN, 0});
  items.push_back({nullptr, sockets_->wake_up, ZMQ_POLLIN, 0});
  for (const int fd : fds) items.push_back({nullptr, fd, ZMQ_POLLIN, 0});
  try {
    zmq::poll(items, timeout);
  } catch (const zmq::error_t&) {
    outcome.woken = true;
    return outcome;
  }
  outcome.messages = items[0].revents != 0;
  if (items[1].revents != 0) {
    zmq::message_t event;
    zmq::message_t address;
    try {
      while (sockets_->monitor.recv(event, zmq::recv_flags::dontwait)) {
        ++sockets_->rejections.handshakes;
        if (event.more()) (void)sockets_->monitor.recv(address, zmq::recv_flags::dontwait);
      }
    } catch (const zmq::error_t&) {
      outcome.woken = true;
    }
  }
  if (items[2].revents != 0) {
    std::uint64_t count = 0;
    outcome.woken = read(sockets_->wake_up, &count, sizeof count) == sizeof count;
  }
  for (std::size_t i = 0; i < fds.size(); ++i) {
    if (items[i + 3].revents != 0) outcome.ready_fds.push_back(fds[i]);
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
