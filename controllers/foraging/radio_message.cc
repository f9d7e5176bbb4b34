#include "controllers/foraging/radio_message.h"

#include <bit>
#include <cstddef>
#include <cstring>

namespace gauntlet::controllers {
namespace {

constexpr std::uint8_t kNestCode = 255;

static_assert(std::endian::native == std::endian::little, "numbers are sent as they are in memory");

void Put(float value, sim::Payload& payload, std::size_t at) {
  std::memcpy(payload.data() + at, &value, sizeof value);
}

float Get(const sim::Payload& payload, std::size_t at) {
  float value = 0.0F;
  std::memcpy(&value, payload.data() + at, sizeof value);
  return value;
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
