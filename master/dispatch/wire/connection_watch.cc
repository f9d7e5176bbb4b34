#include "master/dispatch/wire/connection_watch.h"

#include <linux/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

namespace gauntlet {

namespace {

// What the kernel still holds of the connection goes too, when ZeroMQ closes it.
bool ShutDown(int fd) {
  const linger reset{.l_onoff = 1, .l_linger = 0};
  setsockopt(fd, SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
  return shutdown(fd, SHUT_RDWR) == 0;
}

}  // namespace

ConnectionWatch::ConnectionWatch(std::uint16_t port, std::uint64_t most_bytes, std::size_t most_silent)
    : port_(port),
      most_bytes_(most_bytes),
      most_silent_(most_silent),
      descriptors_(opendir("/proc/self/fd")) {}

void ConnectionWatch::Completed(int fd) {
  if (fd < 0) return;
  const auto index = static_cast<std::size_t>(fd);
  if (index >= completed_.size()) completed_.resize(index + 1);
  completed_[index] = true;
}

ConnectionWatch::Closed ConnectionWatch::Check() {
  Closed closed;
  if (descriptors_ == nullptr) return closed;
  ++checks_;
  std::unordered_map<int, Connection> present;
  rewinddir(descriptors_.get());
  while (const dirent* entry = readdir(descriptors_.get())) {
    int fd = -1;
    const std::string_view name = entry->d_name;
    std::from_chars(name.data(), name.data() + name.size(), fd);
    sockaddr_in local{};
    socklen_t length = sizeof local;
    if (fd < 0 || getsockname(fd, reinterpret_cast<sockaddr*>(&local), &length) != 0) continue;
    if (local.sin_family != AF_INET || ntohs(local.sin_port) != port_) continue;
    sockaddr_in peer{};
    length = sizeof peer;
    if (getpeername(fd, reinterpret_cast<sockaddr*>(&peer), &length) != 0) continue;  // it listens
    tcp_info info{};
    length = sizeof info;
    int unread = 0;
    if (getsockopt(fd, IPPROTO_TCP, TCP_INFO, &info, &length) != 0 || ioctl(fd, FIONREAD, &unread) != 0) {
      continue;
    }
    // Read later than the former figure, what is unread may exceed it.
    const std::uint64_t read =
        info.tcpi_bytes_received - std::min<std::uint64_t>(unread, info.tcpi_bytes_received);

    Connection connection{.address = peer.sin_addr.s_addr, .port = peer.sin_port, .age = checks_};
    const auto former = connections_.find(fd);
    if (former != connections_.end() && former->second.address == connection.address &&
        former->second.port == connection.port) {
      connection = former->second;
    }
    const auto index = static_cast<std::size_t>(fd);
    if (index < completed_.size() && completed_[index]) {
      connection.whole = read;
      connection.spoke = true;
    }
    if (read > connection.whole + most_bytes_) {
      closed.endless += ShutDown(fd) ? 1 : 0;
      continue;
    }
    present.emplace(fd, connection);
  }
  connections_ = std::move(present);
  completed_.assign(completed_.size(), false);
  closed.silent = CloseSilent();
  return closed;
}

int ConnectionWatch::CloseSilent() {
  std::vector<std::pair<std::uint64_t, int>> silent;  // age and descriptor
  for (const auto& [fd, connection] : connections_) {
    if (!connection.spoke) silent.emplace_back(connection.age, fd);
  }
  if (silent.size() <= most_silent_) return 0;
  std::sort(silent.begin(), silent.end());
  silent.resize(silent.size() - most_silent_);
  int closed = 0;
  for (const auto& [age, fd] : silent) {
    closed += ShutDown(fd) ? 1 : 0;
    connections_.erase(fd);
  }
  return closed;
}

}  // namespace gauntlet
