#include "worker/runner/pipe.h"

#include <fmt/format.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace gauntlet::worker {
namespace {

using Length = std::uint32_t;  // in the order of this machine: both ends are processes of it

constexpr std::size_t kMostDescriptors = 2;
constexpr std::size_t kControlBytes = CMSG_SPACE(kMostDescriptors * sizeof(int));

std::size_t LengthIn(const char* prefix) {
  Length length = 0;
  std::memcpy(&length, prefix, sizeof length);
  return length;
}

}  // namespace

Result<SocketPair> MakeSocketPair(int type) {
  std::array<int, 2> fds{};
  if (socketpair(AF_UNIX, type | SOCK_CLOEXEC, 0, fds.data()) != 0) {
    return Error{ErrorKind::kIo, fmt::format("socketpair: {}", std::strerror(errno))};
  }
  return SocketPair{UniqueFd(fds[0]), UniqueFd(fds[1])};
}

bool SendPacket(int socket, std::string_view bytes, std::span<const int> descriptors) {
  GAUNTLET_CHECK(descriptors.size() <= kMostDescriptors, "more descriptors than a packet carries");
  iovec part{.iov_base = const_cast<char*>(bytes.data()), .iov_len = bytes.size()};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, kControlBytes> space{};
  if (!descriptors.empty()) {
    header.msg_control = space.data();
    header.msg_controllen = CMSG_SPACE(descriptors.size_bytes());
    cmsghdr* rights = CMSG_FIRSTHDR(&header);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(descriptors.size_bytes());
    std::memcpy(CMSG_DATA(rights), descriptors.data(), descriptors.size_bytes());
  }
  ssize_t sent = -1;
  do {
    sent = sendmsg(socket, &header, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(bytes.size());
}

std::optional<Packet> ReceivePacket(int socket, std::size_t size, int flags) {
  Packet packet{.bytes = std::string(size, '\0'), .descriptors = {}};
  iovec part{.iov_base = packet.bytes.data(), .iov_len = size};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, kControlBytes> space{};
  header.msg_control = space.data();
  header.msg_controllen = space.size();
  ssize_t got = -1;
  do {
    errno = 0;
    got = recvmsg(socket, &header, flags | MSG_CMSG_CLOEXEC);
  } while (got < 0 && errno == EINTR);
  if (got <= 0) return std::nullopt;
  packet.bytes.resize(static_cast<std::size_t>(got));
  const cmsghdr* rights = CMSG_FIRSTHDR(&header);
  if (rights != nullptr && rights->cmsg_type == SCM_RIGHTS) {
    std::array<int, kMostDescriptors> fds{};
    const std::size_t count = (rights->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    std::memcpy(fds.data(), CMSG_DATA(rights), count * sizeof(int));
    for (std::size_t i = 0; i < count; ++i) packet.descriptors.emplace_back(fds[i]);
  }
  return packet;
}

std::string MakeFrame(std::string_view payload) {
  GAUNTLET_CHECK(payload.size() <= kMaxFrameBytes, fmt::format("a frame of {} bytes", payload.size()));
  const auto length = static_cast<Length>(payload.size());
  std::string frame(sizeof length + payload.size(), '\0');
  std::memcpy(frame.data(), &length, sizeof length);
  payload.copy(frame.data() + sizeof length, payload.size());
  return frame;
}

bool WriteFrame(int fd, std::string_view payload) {
  const std::string frame = MakeFrame(payload);
  std::string_view rest = frame;
  while (!rest.empty()) {
    const ssize_t sent = send(fd, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return false;
    rest.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

FrameBuffer::State FrameBuffer::ReadFrom(int fd, Wait wait) {
  std::array<char, 64 * 1024> chunk;
  int flags = wait == Wait::kYes ? 0 : MSG_DONTWAIT;
  while (true) {
    const ssize_t got = recv(fd, chunk.data(), chunk.size(), flags);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return State::kOpen;
    if (got <= 0) return State::kEnded;
    bytes_.append(chunk.data(), static_cast<std::size_t>(got));
    if (bytes_.size() >= taken_ + sizeof(Length) && LengthIn(bytes_.data() + taken_) > kMaxFrameBytes)
      return State::kDamaged;
    if (static_cast<std::size_t>(got) < chunk.size()) return State::kOpen;
    flags = MSG_DONTWAIT;
  }
}

std::optional<std::string> FrameBuffer::Next() {
  const std::string_view rest = std::string_view(bytes_).substr(taken_);
  if (rest.size() >= sizeof(Length)) {
    const std::size_t size = LengthIn(rest.data());
    if (rest.size() >= sizeof(Length) + size) {
      taken_ += sizeof(Length) + size;
      return std::string(rest.substr(sizeof(Length), size));
    }
  }
  bytes_.erase(0, taken_);
  taken_ = 0;
  return std::nullopt;
}

}  // namespace gauntlet::worker
