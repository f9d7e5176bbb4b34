#include "master/session/metrics_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <string_view>
#include <utility>
#include <vector>

#include "base/system/atomic_file.h"

namespace gauntlet {
namespace {

using RequestClock = std::chrono::steady_clock;

constexpr std::size_t kLongestRequest = 4096;
constexpr std::chrono::milliseconds kLongestTalk{1000};

std::string Response(std::string_view status, std::string_view body, std::string_view more = "") {
  return fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8\r\nContent-Length: {}\r\n"
      "Connection: close\r\n{}\r\n{}",
      status, body.size(), more, body);
}

}  // namespace

Result<std::unique_ptr<MetricsServer>> MetricsServer::Start(int port) {
  UniqueFd listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!listener.valid()) return SystemError("cannot make a socket for metrics", errno);
  const int reuse = 1;
  setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      listen(listener.get(), SOMAXCONN) != 0 ||
      getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    Error error = SystemError(fmt::format("cannot serve metrics on 127.0.0.1:{}", port), errno);
    if (errno == EADDRINUSE) error.kind = ErrorKind::kInUse;
    return error;
  }
  return std::unique_ptr<MetricsServer>(new MetricsServer(std::move(listener), ntohs(address.sin_port)));
}

MetricsServer::MetricsServer(UniqueFd listener, int port) : listener_(std::move(listener)), port_(port) {
  // Signals are for the thread that runs the campaign.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { Loop(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

MetricsServer::~MetricsServer() {
  shutdown(listener_.get(), SHUT_RDWR);  // which ends the thread's loop
  thread_.join();
}

std::string MetricsServer::url() const {
  return fmt::format("http://127.0.0.1:{}/metrics", port_);
}

void MetricsServer::Publish(std::string text) {
  const std::lock_guard lock(mutex_);
  text_ = std::move(text);
}

// Reads one request and writes one answer, as far as the peer lets it without waiting.
class MetricsServer::Connection {
 public:
  explicit Connection(UniqueFd fd) : fd_(std::move(fd)) {}

  pollfd Wish() const { return {fd_.get(), static_cast<short>(idle() ? POLLIN : POLLOUT), 0}; }
  // Nothing whole was asked yet.
  bool idle() const { return answer_.empty(); }
  RequestClock::time_point end() const { return end_; }
  // Answered, broken off or too long.
  bool over() const { return over_; }

  void Advance(MetricsServer& server) {
    if (idle()) Read(server);
    if (!idle()) Write();
  }

 private:
  void Read(MetricsServer& server) {
    std::array<char, kLongestRequest> buffer{};
    const ssize_t size = recv(fd_.get(), buffer.data(), buffer.size() - request_.size(), MSG_DONTWAIT);
    if (size <= 0) {
      over_ = size == 0 || (errno != EAGAIN && errno != EINTR);
      return;
    }
    request_.append(buffer.data(), static_cast<std::size_t>(size));
    if (request_.find("\r\n\r\n") != std::string::npos) {
      answer_ = server.AnswerTo(request_);
    } else {
      over_ = request_.size() == kLongestRequest;
    }
  }

  void Write() {
    const std::string_view rest = std::string_view(answer_).substr(written_);
    const ssize_t size = send(fd_.get(), rest.data(), rest.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (size < 0) {
      over_ = errno != EAGAIN && errno != EINTR;
      return;
    }
    written_ += static_cast<std::size_t>(size);
    over_ = written_ == answer_.size();
  }

  const UniqueFd fd_;
  const RequestClock::time_point end_ = RequestClock::now() + kLongestTalk;
  std::string request_;
  std::string answer_;
  std::size_t written_ = 0;
  bool over_ = false;
};

void MetricsServer::Loop() {
  std::list<Connection> connections;  // the oldest first, so that the first ends first
  std::vector<pollfd> items;
  bool may_accept = true;
  while (true) {
    items.assign({{listener_.get(), static_cast<short>(may_accept ? POLLIN : 0), 0}});
    for (const Connection& connection : connections) items.push_back(connection.Wish());
    int patience = may_accept ? -1 : static_cast<int>(kLongestTalk.count());
    if (!connections.empty()) {
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(connections.front().end() - RequestClock::now());
      patience = static_cast<int>(std::max<std::int64_t>(left.count(), 0));
    }
    if (poll(items.data(), items.size(), patience) < 0 && errno != EINTR) return;
    if ((items[0].revents & POLLHUP) != 0) return;
    std::size_t next = 1;
    for (Connection& connection : connections) {
      if (items[next++].revents != 0) connection.Advance(*this);
    }
    const auto now = RequestClock::now();
    std::erase_if(connections, [now](const Connection& connection) {
      return connection.over() || connection.end() <= now;
    });
    // Out of descriptors: those that wait are announced again at once, so they are not looked at for a while.
    may_accept = !may_accept || items[0].revents == 0 || Accept(connections);
  }
}

bool MetricsServer::Accept(std::list<Connection>& connections) {
  // So many at most, lest a crowd that comes faster than it is served keeps the others waiting.
  for (std::size_t i = 0; i < kMostConnections; ++i) {
    UniqueFd fd(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!fd.valid()) return errno == EAGAIN || errno == EINTR || errno == ECONNABORTED;
    if (connections.size() == kMostConnections) {
      const auto idle = std::ranges::find_if(connections, &Connection::idle);
      connections.erase(idle == connections.end() ? connections.begin() : idle);
    }
    // Most have asked already: the answer goes before others can crowd it out.
    connections.emplace_back(std::move(fd)).Advance(*this);
    if (connections.back().over()) connections.pop_back();
  }
  return true;
}

std::string MetricsServer::AnswerTo(std::string_view request) {
  const std::string_view line = request.substr(0, request.find("\r\n"));
  if (!line.starts_with("GET "))
    return Response("405 Method Not Allowed", "only GET is answered here\n", "Allow: GET\r\n");
  if (!line.starts_with("GET /metrics ") && !line.starts_with("GET /metrics?"))
    return Response("404 Not Found", "only /metrics is served here\n");
  const std::lock_guard lock(mutex_);
  return text_.empty() ? Response("503 Service Unavailable", "the master is starting\n")
                       : Response("200 OK", text_);
}

}  // namespace gauntlet
