// What partitioning robots say over range-and-bearing: 10 bytes, heard in line of sight only.
//
// Byte 0: 0 = says nothing, 1 + state. Byte 1: 1 = carries an item. Byte 2: step of a hand-over. Bytes 3 and
// 4: the robot's own number and its partner's. Bytes 5 to 8: its partition length in m, IEEE 754 single
// precision, little endian; no robot listens to it, the scenario records it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "sim/robot/controller.h"

namespace gauntlet::controllers {

// The five states of thesis 6.2 (Figure 6.1). Sent and recorded by number: do not renumber.
enum class PartitioningState : std::uint8_t {
  kExplore = 0,
  kGoToNest,
  kWaitForTransfer,
  kGoToSource,     // Go to Source Position Estimate
  kNeighbourhood,  // Neighbourhood Exploration
};
inline constexpr std::array<std::string_view, 5> kPartitioningStateNames = {
    "explore", "go-to-nest", "wait-for-transfer", "go-to-source", "neighbourhood"};
inline constexpr int kPartitioningStates = kPartitioningStateNames.size();

// Steps of a hand-over, see handover.h.
enum class HandoverStep : std::uint8_t {
  kNone = 0,
  kOffer,    // a giver without a partner
  kRequest,  // a receiver to its giver: here, gripper closed
  kGrant,    // a giver to its receiver: both stand still
  kRelease,  // a giver to its receiver: take it
};
inline constexpr int kHandoverSteps = 5;

struct PartitionMessage {
  bool from_robot = false;
  PartitioningState state = PartitioningState::kExplore;
  bool carrying = false;
  HandoverStep step = HandoverStep::kNone;
  std::uint8_t self = 0;
  std::uint8_t partner = 0;  // of kRequest, kGrant and kRelease
  float partition_length = 0.0F;

  bool operator==(const PartitionMessage&) const = default;
};

// The step that DecodePartition would give, for a fraction of the work; meaningless of anything but a robot's
// message.
inline HandoverStep StepIn(const sim::Payload& payload) {
  return static_cast<HandoverStep>(payload[2]);
}

sim::Payload Encode(const PartitionMessage& message);
// Anything that Encode cannot have written comes from nobody.
PartitionMessage DecodePartition(const sim::Payload& payload);

}  // namespace gauntlet::controllers
