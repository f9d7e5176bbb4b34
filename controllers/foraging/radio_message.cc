#include "controllers/foraging/radio_message.h"

#include <bit>
#include <cstddef>

namespace gauntlet::controllers {
namespace {

constexpr std::uint8_t kNestCode = 255;

void Put(float value, sim::Payload& payload, std::size_t at) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (std::size_t i = 0; i < 4; ++i) payload[at + i] = static_cast<std::uint8_t>(bits >> (8 * i));
}

float Get(const sim::Payload& payload, std::size_t at) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(payload[at + i]) << (8 * i);
  return std::bit_cast<float>(bits);
}

}  // namespace

sim::Payload Encode(const RadioMessage& message) {
  sim::Payload payload{};
  if (message.sender == RadioMessage::Sender::kNobody) return payload;
  payload[0] = message.sender == RadioMessage::Sender::kNest
                   ? kNestCode
                   : static_cast<std::uint8_t>(1 + static_cast<int>(message.state));
  payload[1] = message.carrying ? 1 : 0;
  Put(message.first, payload, 2);
  Put(message.second, payload, 6);
  return payload;
}

RadioMessage Decode(const sim::Payload& payload) {
  RadioMessage message;
  if (payload[0] == kNestCode) {
    message.sender = RadioMessage::Sender::kNest;
  } else if (payload[0] >= 1 && payload[0] <= kForagingStates) {
    message.sender = RadioMessage::Sender::kRobot;
    message.state = static_cast<ForagingState>(payload[0] - 1);
  } else {
    return message;
  }
  message.carrying = payload[1] == 1;
  message.first = Get(payload, 2);
  message.second = Get(payload, 6);
  return message;
}

}  // namespace gauntlet::controllers
