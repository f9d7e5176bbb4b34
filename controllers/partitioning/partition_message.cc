#include "controllers/partitioning/partition_message.h"

#include <bit>
#include <cstddef>

namespace gauntlet::controllers {

sim::Payload Encode(const PartitionMessage& message) {
  sim::Payload payload{};
  if (!message.from_robot) return payload;
  payload[0] = static_cast<std::uint8_t>(1 + static_cast<int>(message.state));
  payload[1] = message.carrying ? 1 : 0;
  payload[2] = static_cast<std::uint8_t>(message.step);
  payload[3] = message.self;
  payload[4] = message.partner;
  const auto bits = std::bit_cast<std::uint32_t>(message.partition_length);
  for (std::size_t i = 0; i < 4; ++i) payload[5 + i] = static_cast<std::uint8_t>(bits >> (8 * i));
  return payload;
}

PartitionMessage DecodePartition(const sim::Payload& payload) {
  PartitionMessage message;
  if (payload[0] < 1 || payload[0] > kPartitioningStates || payload[2] >= kHandoverSteps) return message;
  message.from_robot = true;
  message.state = static_cast<PartitioningState>(payload[0] - 1);
  message.carrying = payload[1] == 1;
  message.step = static_cast<HandoverStep>(payload[2]);
  message.self = payload[3];
  message.partner = payload[4];
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(payload[5 + i]) << (8 * i);
  message.partition_length = std::bit_cast<float>(bits);
  return message;
}

}  // namespace gauntlet::controllers
