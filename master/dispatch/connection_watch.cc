#include "master/dispatch/connection_watch.h"

#include <linux/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

namespace gauntlet::master {

void ConnectionWatch::Completed(int fd) {
  if (fd < 0) return;
  const auto index = static_cast<std::size_t>(fd);
  if (index >= completed_.size()) completed_.resize(index + 1);
  completed_[index] = true;
}

int ConnectionWatch::Check() {
  std::error_code error;
  std::filesystem::directory_iterator entry("/proc/self/fd", error);
  if (error) return 0;  // no descriptor is left; those who connect now are closed by ZeroMQ
  std::unordered_map<int, Connection> present;
  int closed = 0;
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    int fd = -1;
    const std::string name = entry->path().filename();
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

    Connection connection{peer.sin_addr.s_addr, peer.sin_port, 0};
    const auto former = connections_.find(fd);
    if (former != connections_.end() && former->second.address == connection.address &&
        former->second.port == connection.port) {
      connection.whole = former->second.whole;
    }
    const auto index = static_cast<std::size_t>(fd);
    if (index < completed_.size() && completed_[index]) connection.whole = read;
    if (read > connection.whole + most_bytes_) {
      // What the kernel still holds of it goes too, when ZeroMQ closes it.
      const linger reset{.l_onoff = 1, .l_linger = 0};
      setsockopt(fd, SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
      closed += shutdown(fd, SHUT_RDWR) == 0 ? 1 : 0;
      continue;
    }
    present.emplace(fd, connection);
  }
  connections_ = std::move(present);
  completed_.assign(completed_.size(), false);
  return closed;
}

}  // namespace gauntlet::master
