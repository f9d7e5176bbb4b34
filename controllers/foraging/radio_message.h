// What foraging robots and the nest say over range-and-bearing: 10 bytes, and nothing else passes between
// robots (thesis 5.2: only local communication).
//
// Byte 0: 0 = says nothing, 1 + state of a robot, kNestCode = the nest. Byte 1: 1 = carries an item.
// Bytes 2-5 and 6-9: two IEEE 754 single precision numbers, little endian.
//   a beacon:      staleness of its pheromone towards the nest, and towards the food
//   other robots:  seconds since it was at the place it comes from (the food when carrying, else the nest), 0
//   the nest:      0, 0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "sim/robot/controller.h"

namespace gauntlet::controllers {

// The seven states of thesis 5.2.1 (the basic algorithm of 2.4.2.1 has the four without beacons). Sent and
// recorded by number: do not renumber.
enum class ForagingState : std::uint8_t {
  kWandering = 0,
  kFollowing,
  kGathering,
  kHoming,
  kFollowingHome,  // F-Homing
  kDropping,
  kBeacon,
};
inline constexpr std::array<std::string_view, 7> kForagingStateNames = {
    "wandering", "following", "gathering", "homing", "f-homing", "dropping", "beacon"};
inline constexpr int kForagingStates = kForagingStateNames.size();

static_assert(std::endian::native == std::endian::little, "numbers are sent as they are in memory");

struct RadioMessage {
  enum class Sender : std::uint8_t { kNobody, kRobot, kNest };

  Sender sender = Sender::kNobody;
  ForagingState state = ForagingState::kWandering;  // of a robot
  bool carrying = false;
  float first = 0.0F;
  float second = 0.0F;

  bool operator==(const RadioMessage&) const = default;
};

// What Decode would say, for a fraction of the work: robots hear hundreds of messages per second.
inline constexpr std::uint8_t kNestCode = 255;
inline bool ComesFromNest(const sim::Payload& payload) {
  return payload[0] == kNestCode;
}
inline bool ComesFromBeacon(const sim::Payload& payload) {
  return payload[0] == 1 + static_cast<int>(ForagingState::kBeacon);
}
inline bool ComesFromForager(const sim::Payload& payload) {
  return payload[0] >= 1 && payload[0] <= static_cast<int>(ForagingState::kBeacon);
}
// Of a robot.
inline bool CarriesIn(const sim::Payload& payload) {
  return payload[1] == 1;
}
inline float FirstIn(const sim::Payload& payload) {
  float value = 0.0F;
  std::memcpy(&value, payload.data() + 2, sizeof value);
  return value;
}
inline float SecondIn(const sim::Payload& payload) {
  float value = 0.0F;
  std::memcpy(&value, payload.data() + 6, sizeof value);
  return value;
}
// The sender's state; of anything but a robot's message: wandering.
inline ForagingState StateIn(const sim::Payload& payload) {
  return payload[0] >= 1 && payload[0] <= kForagingStates ? static_cast<ForagingState>(payload[0] - 1)
                                                          : ForagingState::kWandering;
}

sim::Payload Encode(const RadioMessage& message);
// Anything that Encode cannot have written comes from nobody.
RadioMessage Decode(const sim::Payload& payload);

}  // namespace gauntlet::controllers
