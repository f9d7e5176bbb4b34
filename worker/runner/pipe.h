// Length-prefixed messages over a stream socket between a supervisor and its runners.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/system/unique_fd.h"

namespace gauntlet::worker {

struct SocketPair {
  UniqueFd first;
  UniqueFd second;
};
// A connected pair of Unix sockets of `type` (SOCK_STREAM, SOCK_SEQPACKET), closed on exec. Error: kIo.
Result<SocketPair> MakeSocketPair(int type);

// A frame is its payload's length (4 bytes) and the payload.
inline constexpr std::size_t kMaxFrameBytes = 1u << 30;

// One packet, with descriptors that the other side gets copies of. Blocking; false: nobody is there.
bool SendPacket(int socket, std::string_view bytes, std::span<const int> descriptors);
struct Packet {
  std::string bytes;
  std::vector<UniqueFd> descriptors;  // fewer than were sent when this process may not open so many
};
// The next packet, of at most `size` bytes with at most two descriptors. `flags` of recvmsg. Empty with
// errno: there is none (EAGAIN), or the other side has ended (0).
std::optional<Packet> ReceivePacket(int socket, std::size_t size, int flags);

std::string MakeFrame(std::string_view payload);

// Blocking; false when the other side is gone.
bool WriteFrame(int fd, std::string_view payload);

// Collects bytes until a frame is complete.
class FrameBuffer {
 public:
  enum class State { kOpen, kEnded, kDamaged };

  enum class Wait { kNo, kYes };

  // Reads what `fd` has to give; kYes: and waits until it has something. kEnded: the other side has closed;
  // frames may be left.
  State ReadFrom(int fd, Wait wait = Wait::kNo);
  // The next complete payload.
  std::optional<std::string> Next();

 private:
  std::string bytes_;
  std::size_t taken_ = 0;  // of them, by Next
};

}  // namespace gauntlet::worker
