// Handing an item from robot to robot (thesis 6.1, direct transfer), as a protocol between two radios.
//
//   giver                                    receiver
//   kOffer, green beacon                     sees the beacon, drives up to it, stops
//                                            kRequest to the giver, gripper closed
//   kGrant to it, beacon dark: both stand    stands as long as it hears that
//   kRelease after the transfer time         has the item, goes
//
// The item moves in one step, made by the scenario when the giver says kRelease and the receiver kRequest to
// each other within reach and in sight. Until then it is the giver's, so whoever falls silent, leaves, or
// dies at any moment: it never exists twice nor vanishes. Neither side waits for ever for the other.
#pragma once

#include <optional>
#include <span>

#include "controllers/partitioning/partition_message.h"

namespace gauntlet::controllers {

struct HandoverSettings {
  double begin_reach = 0.0;  // m between centres: a receiver stops and asks
  double keep_reach = 0.0;   // m: farther apart the hand-over is off
  sim::Tick transfer = 0;    // both stand this long
  sim::Tick silence = 0;     // a partner unheard for longer is gone
  sim::Tick answer = 0;      // a receiver waits this long for an answer, a giver for the item to be taken
  sim::Tick bar = 0;         // a receiver asks nobody for this long after it was not answered
};

// A message heard, and how far away its sender is.
struct HeardMessage {
  double range = 0.0;  // m
  PartitionMessage message;
};

// Of a robot that waits with an item.
class Giver {
 public:
  Giver(const HandoverSettings& settings, std::uint8_t self) : settings_(settings), self_(self) {}

  // One tick of waiting. Of several requests it takes that of the lowest number.
  void Listen(std::span<const HeardMessage> heard);
  void Reset() { partner_.reset(); }

  // Whether a hand-over is under way that may still succeed.
  bool engaged() const { return partner_.has_value() && engaged_ <= settings_.transfer + settings_.answer; }
  HandoverStep step() const;
  std::uint8_t partner() const { return partner_.value_or(0); }

 private:
  HandoverSettings settings_;
  std::uint8_t self_;
  std::optional<std::uint8_t> partner_;
  sim::Tick engaged_ = 0;  // ticks since the grant
  sim::Tick unheard_ = 0;
};

// Of a robot without an item.
class Receiver {
 public:
  Receiver(const HandoverSettings& settings, std::uint8_t self) : settings_(settings), self_(self) {}

  // One tick. `at_carrier`: a green beacon is within begin_reach.
  void Listen(bool at_carrier, std::span<const HeardMessage> heard);
  // The item arrived, or is wanted no more.
  void Reset();

  // Stands at a carrier with a closed gripper.
  bool engaged() const { return engaged_; }
  // After nobody answered it takes no notice of carriers for a while.
  bool barred() const { return barred_ > 0; }
  HandoverStep step() const { return giver_ ? HandoverStep::kRequest : HandoverStep::kNone; }
  std::uint8_t partner() const { return giver_.value_or(0); }

 private:
  void Begin(std::span<const HeardMessage> heard);
  void GiveUp(bool bar);

  HandoverSettings settings_;
  std::uint8_t self_;
  bool engaged_ = false;
  std::optional<std::uint8_t> giver_;
  bool granted_ = false;
  sim::Tick waited_ = 0;  // ticks since it stopped, or since the grant
  sim::Tick unheard_ = 0;
  sim::Tick barred_ = 0;  // ticks left
};

}  // namespace gauntlet::controllers
