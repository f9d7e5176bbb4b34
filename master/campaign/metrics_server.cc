#include "master/campaign/metrics_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <string_view>
#include <utility>

#include "master/campaign/atomic_file.h"

namespace gauntlet::master {
namespace {

using RequestClock = std::chrono::steady_clock;

constexpr int kQueue = 16;
constexpr std::size_t kLongestRequest = 4096;
constexpr std::chrono::milliseconds kLongestTalk{1000};

int MillisecondsUntil(RequestClock::time_point end) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - RequestClock::now()).count();
  return left > 0 ? static_cast<int>(left) : 0;
}

bool WaitFor(int fd, short events, RequestClock::time_point end) {
  pollfd item{fd, events, 0};
  return poll(&item, 1, MillisecondsUntil(end)) > 0;
}

// Up to the empty line; "" when it is too long, too slow or cut off.
std::string ReadRequest(int fd, RequestClock::time_point end) {
  std::string request;
  std::array<char, 1024> buffer{};
  while (request.size() < kLongestRequest && WaitFor(fd, POLLIN, end)) {
    const ssize_t size = recv(fd, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (size <= 0) return "";
    request.append(buffer.data(), static_cast<std::size_t>(size));
    if (request.find("\r\n\r\n") != std::string::npos) return request;
  }
  return "";
}

void WriteAnswer(int fd, std::string_view bytes, RequestClock::time_point end) {
  while (!bytes.empty() && WaitFor(fd, POLLOUT, end)) {
    const ssize_t size = send(fd, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (size <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(size));
  }
}

std::string Response(std::string_view status, std::string_view body, std::string_view more = "") {
  return fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8\r\nContent-Length: {}\r\n"
      "Connection: close\r\n{}\r\n{}",
      status, body.size(), more, body);
}

}  // namespace

Result<std::unique_ptr<MetricsServer>> MetricsServer::Start(int port) {
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (listener < 0) return SystemError("cannot make a socket for metrics", errno);
  const int reuse = 1;
  setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const int wake_up = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (wake_up < 0 || bind(listener, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      listen(listener, kQueue) != 0 ||
      getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    Error error = SystemError(fmt::format("cannot serve metrics on 127.0.0.1:{}", port), errno);
    if (errno == EADDRINUSE) error.kind = ErrorKind::kInUse;
    close(listener);
    if (wake_up >= 0) close(wake_up);
    return error;
  }
  return std::unique_ptr<MetricsServer>(new MetricsServer(listener, wake_up, ntohs(address.sin_port)));
}

MetricsServer::MetricsServer(int listener, int wake_up, int port)
    : listener_(listener), wake_up_(wake_up), port_(port) {
  // Signals are for the thread that runs the campaign.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { Loop(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

MetricsServer::~MetricsServer() {
  const std::uint64_t one = 1;
  // Fails only when the counter is at its maximum: then it is readable anyway.
  [[maybe_unused]] const ssize_t written = write(wake_up_, &one, sizeof one);
  thread_.join();
  close(listener_);
  close(wake_up_);
}

std::string MetricsServer::url() const {
  return fmt::format("http://127.0.0.1:{}/metrics", port_);
}

void MetricsServer::Publish(std::string text) {
  const std::lock_guard lock(mutex_);
  text_ = std::move(text);
}

void MetricsServer::Loop() {
  while (true) {
    std::array<pollfd, 2> items{{{listener_, POLLIN, 0}, {wake_up_, POLLIN, 0}}};
    if (poll(items.data(), items.size(), -1) < 0 && errno != EINTR) return;
    if (items[1].revents != 0) return;
    if (items[0].revents == 0) continue;
    const int connection = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0) {
      // Out of descriptors, perhaps: the connection waits, and so do we, for it would be announced again.
      poll(&items[1], 1, static_cast<int>(kLongestTalk.count()));
      continue;
    }
    Answer(connection);
    close(connection);
  }
}

void MetricsServer::Answer(int connection) {
  const auto end = RequestClock::now() + kLongestTalk;
  const std::string request = ReadRequest(connection, end);
  if (request.empty()) return;
  const std::string_view line = std::string_view(request).substr(0, request.find("\r\n"));
  std::string response;
  if (!line.starts_with("GET ")) {
    response = Response("405 Method Not Allowed", "only GET is answered here\n", "Allow: GET\r\n");
  } else if (!line.starts_with("GET /metrics ") && !line.starts_with("GET /metrics?")) {
    response = Response("404 Not Found", "only /metrics is served here\n");
  } else {
    const std::lock_guard lock(mutex_);
    response = text_.empty() ? Response("503 Service Unavailable", "the master is starting\n")
                             : Response("200 OK", text_);
  }
  WriteAnswer(connection, response, end);
}

}  // namespace gauntlet::master
