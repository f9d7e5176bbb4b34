#include "argos/mailbox.h"

#include <algorithm>
#include <cstring>

namespace gauntlet::argos_form {
namespace {

// A message: these bytes, the slot, the robot's number. No scenario sends the like.
constexpr std::uint8_t kMark[] = {0x67, 0x61, 0x75, 0x6e, 0x74};
constexpr std::size_t kSlotPlace = sizeof kMark;
constexpr std::size_t kRobotPlace = kSlotPlace + 1;
static_assert(kRobotPlace + sizeof(sim::RobotIndex) == sim::Payload().size());

}  // namespace

sim::Payload Mailbox::Put(sim::RobotIndex robot, std::span<const std::uint8_t> bytes) {
  const auto index = static_cast<std::size_t>(robot);
  if (boxes_.size() <= index) boxes_.resize(index + 1);
  Box& box = boxes_[index];
  box.newest ^= 1;
  box.slots[box.newest].assign(bytes.begin(), bytes.end());
  sim::Payload message{};
  std::ranges::copy(kMark, message.begin());
  message[kSlotPlace] = box.newest;
  std::memcpy(message.data() + kRobotPlace, &robot, sizeof robot);
  return message;
}

std::span<const std::uint8_t> Mailbox::Get(const sim::Payload& message) const {
  if (!std::equal(std::begin(kMark), std::end(kMark), message.begin())) return {};
  sim::RobotIndex robot = 0;
  std::memcpy(&robot, message.data() + kRobotPlace, sizeof robot);
  if (robot < 0 || static_cast<std::size_t>(robot) >= boxes_.size() || message[kSlotPlace] > 1) return {};
  return boxes_[static_cast<std::size_t>(robot)].slots[message[kSlotPlace]];
}

}  // namespace gauntlet::argos_form
