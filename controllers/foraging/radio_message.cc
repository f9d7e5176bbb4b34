#include "controllers/foraging/radio_message.h"

#include <cstddef>
#include <cstring>

namespace gauntlet::controllers {
namespace {

void Put(float value, sim::Payload& payload, std::size_t at) {
  std::memcpy(payload.data() + at, &value, sizeof value);
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
  if (ComesFromNest(payload)) {
    message.sender = RadioMessage::Sender::kNest;
  } else if (payload[0] >= 1 && payload[0] <= kForagingStates) {
    message.sender = RadioMessage::Sender::kRobot;
    message.state = static_cast<ForagingState>(payload[0] - 1);
  } else {
    return message;
  }
  message.carrying = CarriesIn(payload);
  message.first = FirstIn(payload);
  message.second = SecondIn(payload);
  return message;
}

}  // namespace gauntlet::controllers
