#include "master/dispatch/wire/zmq_transport.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>
#include <utility>
#include <zmq.hpp>

#include "base/system/clock.h"
#include "base/system/unique_fd.h"
#include "base/thread_sanitizer.h"
#include "master/dispatch/wire/connection_watch.h"

namespace gauntlet {
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
// With thousands of connections looking at them takes long: so many times that long lies between.
constexpr int kLeastBetween = 40;
constexpr std::chrono::seconds kLongestGreeting{10};
constexpr int kLingerMilliseconds = 100;  // for the last messages to leave
constexpr const char* kMonitorAddress = "inproc://gauntlet-transport-monitor";
constexpr int kMonitoredEvents = ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_HANDSHAKE_SUCCEEDED |
                                 ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL |
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

// Connections that have said nothing may take half of the descriptors that this process may have.
std::size_t MostSilent() {
  rlimit limit{};
  return getrlimit(RLIMIT_NOFILE, &limit) == 0 ? static_cast<std::size_t>(limit.rlim_cur / 2) : 512;
}

// All of it; keeps zmq.hpp out of the header.
class RouterTransport final : public ZmqTransport {
 public:
  // Binds. Throws zmq::error_t.
  RouterTransport(const ZmqTransportOptions& options, UniqueFd wake_up)
      : wake_up_(std::move(wake_up)), max_message_bytes_(options.max_message_bytes) {
    router_.set(zmq::sockopt::router_mandatory, true);
    router_.set(zmq::sockopt::router_handover, true);
    router_.set(zmq::sockopt::maxmsgsize,
                static_cast<std::int64_t>(options.max_message_bytes + kConnectionMargin));
    router_.set(zmq::sockopt::sndhwm, options.peer_queue);
    router_.set(zmq::sockopt::rcvhwm, options.peer_queue);
    router_.set(zmq::sockopt::linger, kLingerMilliseconds);
    router_.set(zmq::sockopt::backlog, 1024);
    if (options.sign_of_life.count() > 0) SetSignOfLife(options.sign_of_life);
    if (zmq_socket_monitor(router_.handle(), kMonitorAddress, kMonitoredEvents) != 0) throw zmq::error_t();
    monitor_.set(zmq::sockopt::linger, 0);
    monitor_.connect(kMonitorAddress);
    CountHandshakes();
    if (options.curve) UseCurve(*options.curve);
    router_.bind(options.endpoint);
    router_fd_ = router_.get(zmq::sockopt::fd);
    monitor_fd_ = monitor_.get(zmq::sockopt::fd);
    endpoint_ = router_.get(zmq::sockopt::last_endpoint);
    if (const std::uint16_t port = PortOf(endpoint_); port != 0)
      watch_.emplace(port, kLongestUnended * options.max_message_bytes, MostSilent());
  }

  const std::string& endpoint() const override { return endpoint_; }
  SendOutcome Send(const PeerId& peer, std::string_view bytes) override;
  void Receive(std::size_t limit, std::vector<PeerMessage>& messages) override;
  WaitOutcome Wait(std::chrono::milliseconds timeout, std::span<const int> fds) override;
  void WakeUp() override;
  void SetSignOfLife(std::chrono::milliseconds time) override {
    if (time == sign_of_life_) return;
    sign_of_life_ = time;
    router_.set(zmq::sockopt::heartbeat_ivl, static_cast<int>(time.count()));
    router_.set(zmq::sockopt::heartbeat_timeout, static_cast<int>(time.count()));
  }
  TransportRejections Rejections() const override { return rejections_; }
  // Should the end of a greeting go unheard, it is forgotten with the crowd that it came with.
  int Greeting() const override {
    return std::chrono::steady_clock::now() - accepted_ < kLongestGreeting ? greeting_ : 0;
  }
  bool KnowsItsPeers() const override { return zap_.has_value(); }

 private:
  void NoteWhole(zmq::message_t& last_part) {
    if (watch_) watch_->Completed(zmq_msg_get(last_part.handle(), ZMQ_SRCFD));
  }
  void WatchConnections(std::chrono::milliseconds every) {
    if (!watch_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now < watched_ + std::max<Duration>(every, kLeastBetween * watch_cost_)) return;
    watched_ = now;
    const ConnectionWatch::Closed closed = watch_->Check();
    watch_cost_ = std::chrono::steady_clock::now() - now;
    rejections_.malformed += static_cast<std::uint64_t>(closed.endless);
    rejections_.silent += static_cast<std::uint64_t>(closed.silent);
  }

  void UseCurve(const CampaignKeys& keys) {
    std::string bytes(32, '\0');
    const char* admitted = keys.worker.public_key.c_str();
    if (zmq_z85_decode(reinterpret_cast<std::uint8_t*>(bytes.data()), admitted) != nullptr)
      admitted_ = std::move(bytes);
    zap_.emplace(context_, zmq::socket_type::rep);
    zap_->set(zmq::sockopt::linger, 0);
    zap_->bind("inproc://zeromq.zap.01");  // the address that ZAP (RFC 27) names
    zap_fd_ = zap_->get(zmq::sockopt::fd);
    AnswerZap();
    router_.set(zmq::sockopt::curve_server, true);
    router_.set(zmq::sockopt::curve_secretkey, keys.master.secret_key);
    router_.set(zmq::sockopt::zap_domain, "gauntlet");
  }

  // ZAP 1.0 (RFC 27): version, request id, domain, address, identity, mechanism, credentials.
  void AnswerZap() {
    std::vector<std::string> request;
    zmq::message_t frame;
    while (zap_->recv(frame, zmq::recv_flags::dontwait)) {
      request.assign(1, frame.to_string());
      while (frame.more() && zap_->recv(frame, zmq::recv_flags::dontwait))
        request.push_back(frame.to_string());
      const bool known = request.size() == 7 && request[5] == "CURVE" && admitted_ == request[6];
      const std::string id = request.size() > 1 ? request[1] : "";
      const std::array<std::string, 6> reply{"1.0", id, known ? "200" : "400", known ? "OK" : "unknown key",
                                             "",    ""};
      for (std::size_t i = 0; i < reply.size(); ++i) {
        const bool last = i + 1 == reply.size();
        zap_->send(zmq::buffer(reply[i]), last ? zmq::send_flags::none : zmq::send_flags::sndmore);
      }
    }
  }

  // Reads the monitor until it is empty: only then its descriptor announces the next event.
  void CountHandshakes() {
    zmq::message_t event;
    zmq::message_t address;
    while (monitor_.recv(event, zmq::recv_flags::dontwait)) {
      std::uint16_t kind = 0;
      if (event.size() >= sizeof kind) std::memcpy(&kind, event.data(), sizeof kind);
      greeting_ = std::max(0, greeting_ + (kind == ZMQ_EVENT_ACCEPTED ? 1 : -1));
      if (kind == ZMQ_EVENT_ACCEPTED) accepted_ = std::chrono::steady_clock::now();
      if (kind != ZMQ_EVENT_ACCEPTED && kind != ZMQ_EVENT_HANDSHAKE_SUCCEEDED)
        ++(kind == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH ? rejections_.keys : rejections_.handshakes);
      if (event.more()) (void)monitor_.recv(address, zmq::recv_flags::dontwait);
    }
  }

  zmq::context_t context_{1};
  std::optional<zmq::socket_t> zap_;  // asked by libzmq about every key that connects
  zmq::socket_t router_{context_, zmq::socket_type::router};
  zmq::socket_t monitor_{context_, zmq::socket_type::pair};
  const UniqueFd wake_up_;               // eventfd
  int zap_fd_ = -1;                      // -1: no keys, nobody asks
  std::optional<std::string> admitted_;  // the public key of workers, 32 bytes
  const std::size_t max_message_bytes_;
  std::string endpoint_;
  std::chrono::milliseconds sign_of_life_{0};  // 0: connections are never asked
  TransportRejections rejections_;
  int greeting_ = 0;
  std::chrono::steady_clock::time_point accepted_{};
  int router_fd_ = -1;
  int monitor_fd_ = -1;
  std::vector<pollfd> poll_items_;
  std::optional<ConnectionWatch> watch_;  // none: not of TCP
  std::chrono::steady_clock::time_point watched_ = std::chrono::steady_clock::now();
  Duration watch_cost_{};
};

SendOutcome RouterTransport::Send(const PeerId& peer, std::string_view bytes) {
  try {
    zmq::message_t identity(peer.data(), peer.size());
    if (!router_.send(identity, zmq::send_flags::sndmore | zmq::send_flags::dontwait)) {
      return SendOutcome::kFull;
    }
    zmq::message_t body(bytes.data(), bytes.size());
    return router_.send(body, zmq::send_flags::dontwait) ? SendOutcome::kSent : SendOutcome::kFull;
  } catch (const zmq::error_t&) {
    return SendOutcome::kUnreachable;
  }
}

void RouterTransport::Receive(std::size_t limit, std::vector<PeerMessage>& messages) {
  zmq::message_t identity;
  zmq::message_t frame;
  std::size_t bytes = 0;
  for (std::size_t received = 0; received < limit; ++received) {
    if (bytes >= kLongestAtOnce * max_message_bytes_) break;
    try {
      if (!router_.recv(identity, zmq::recv_flags::dontwait)) {
        return WatchConnections(kWatchEvery);
      }
      if (!identity.more()) {
        ++rejections_.malformed;
        continue;
      }
      // The parts of one message arrive together.
      if (!router_.recv(frame, zmq::recv_flags::dontwait)) return;
      if (frame.more()) {
        ++rejections_.malformed;
        while (frame.more() && router_.recv(frame, zmq::recv_flags::dontwait)) continue;
        NoteWhole(frame);
        continue;
      }
    } catch (const zmq::error_t&) {
      return;  // interrupted by a signal: what is there is received next time
    }
    NoteWhole(frame);
    bytes += frame.size();
    if (frame.size() > max_message_bytes_) {
      ++rejections_.oversized;
      continue;
    }
    messages.push_back({identity.to_string(), frame.to_string()});
  }
  WatchConnections(kWatchAtLeast);
}

// Our own poll over libzmq's descriptors: zmq_poll asks every socket for its state before and after, some ten
// system calls each time. ZMQ_FD says only that something may have changed, so the state is asked before
// sleeping (what was left when Receive stopped is not announced again) and after.
WaitOutcome RouterTransport::Wait(std::chrono::milliseconds timeout, std::span<const int> fds) {
  WaitOutcome outcome;
  const auto readable = [this] { return (router_.get(zmq::sockopt::events) & ZMQ_POLLIN) != 0; };
  try {
    outcome.messages = readable();
    std::vector<pollfd>& items = poll_items_;
    items.clear();
    items.push_back({router_fd_, POLLIN, 0});
    items.push_back({monitor_fd_, POLLIN, 0});
    items.push_back({wake_up_.get(), POLLIN, 0});
    items.push_back({zap_fd_, POLLIN, 0});
    for (const int fd : fds) items.push_back({fd, POLLIN, 0});
    const int wait = outcome.messages ? 0 : static_cast<int>(timeout.count());
    if (poll(items.data(), items.size(), wait) < 0) {
      outcome.woken = true;
      return outcome;
    }
    if (!outcome.messages && items[0].revents != 0) outcome.messages = readable();
    if (items[1].revents != 0) CountHandshakes();
    if (items[2].revents != 0) {
      std::uint64_t count = 0;
      outcome.woken = read(wake_up_.get(), &count, sizeof count) == sizeof count;
    }
    if (items[3].revents != 0) AnswerZap();
    for (std::size_t i = 0; i < fds.size(); ++i) {
      if (items[i + 4].revents != 0) outcome.ready_fds.push_back(fds[i]);
    }
  } catch (const zmq::error_t&) {
    outcome.woken = true;  // interrupted by a signal
  }
  return outcome;
}

void RouterTransport::WakeUp() {
  const std::uint64_t one = 1;
  // Fails only when the counter is at its maximum: then it is readable anyway.
  [[maybe_unused]] const ssize_t written = write(wake_up_.get(), &one, sizeof one);
}

}  // namespace

Result<std::unique_ptr<ZmqTransport>> ZmqTransport::Bind(const ZmqTransportOptions& options) {
  if (SomebodyListens(options.endpoint)) {
    return Error{ErrorKind::kInUse,
                 fmt::format("cannot listen on '{}': another process does", options.endpoint)};
  }
  UniqueFd wake_up(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!wake_up.valid()) {
    return Error{ErrorKind::kIo, fmt::format("cannot make an eventfd: {}", std::strerror(errno))};
  }
  try {
    return std::unique_ptr<ZmqTransport>(new RouterTransport(options, std::move(wake_up)));
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

}  // namespace gauntlet
