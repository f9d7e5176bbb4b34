#include "tests/integration/hostile_sockets.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <utility>

namespace gauntlet::testing_support {

HostileSocket::HostileSocket(int port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (fd_ < 0) return;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  timeval patience{.tv_sec = 0, .tv_usec = 200'000};  // for a listener whose queue is full
  setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  connected_ = connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
}

HostileSocket::HostileSocket(HostileSocket&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), connected_(other.connected_) {}

HostileSocket::~HostileSocket() {
  if (fd_ >= 0) close(fd_);
}

void HostileSocket::Send(const std::string& bytes) {
  for (std::size_t sent = 0; connected_ && sent < bytes.size();) {
    const ssize_t size = send(fd_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (size <= 0) return;
    sent += static_cast<std::size_t>(size);
  }
}

std::string HostileSocket::HearOut() {
  std::string heard;
  if (!connected_) return heard;
  timeval patience{.tv_sec = 0, .tv_usec = 50'000};
  setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  shutdown(fd_, SHUT_WR);
  char part[512];
  for (ssize_t size = 0; (size = recv(fd_, part, sizeof part, 0)) > 0;)
    heard.append(part, static_cast<std::size_t>(size));
  return heard;
}

std::string ZmtpHandshake() {
  std::string greeting = "\xff";
  greeting += std::string(8, '\0') + "\x7f";
  greeting += "\x03";
  greeting += std::string(1, '\0');
  greeting += "NULL" + std::string(16, '\0');
  greeting += std::string(1, '\0') + std::string(31, '\0');
  const std::string ready = std::string("\x05READY", 6) + std::string("\x0bSocket-Type", 12) +
                            std::string("\0\0\0\x06", 4) + "DEALER";
  return greeting + "\x04" + static_cast<char>(ready.size()) + ready;
}

std::string ZmtpMessage(const std::string& body) {
  std::string bytes(1, '\x02');  // long
  for (int shift = 56; shift >= 0; shift -= 8)
    bytes += static_cast<char>(static_cast<std::uint64_t>(body.size()) >> shift);
  return bytes + body;
}

}  // namespace gauntlet::testing_support
