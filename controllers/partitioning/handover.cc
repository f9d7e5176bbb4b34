#include "controllers/partitioning/handover.h"

#include <algorithm>

namespace gauntlet::controllers {

void Giver::Listen(std::span<const HeardMessage> heard) {
  const auto requests_within = [&](const HeardMessage& one, double reach) {
    return one.message.step == HandoverStep::kRequest && one.message.partner == self_ && one.range <= reach;
  };
  if (partner_) {
    ++engaged_;
    const bool there = std::any_of(heard.begin(), heard.end(), [&](const HeardMessage& one) {
      return one.message.self == *partner_ && requests_within(one, settings_.keep_reach);
    });
    unheard_ = there ? 0 : unheard_ + 1;
    if (unheard_ > settings_.silence) partner_.reset();
    return;
  }
  for (const HeardMessage& one : heard) {
    if (!requests_within(one, settings_.keep_reach)) continue;
    if (!partner_ || one.message.self < *partner_) partner_ = one.message.self;
  }
  engaged_ = 0;
  unheard_ = 0;
}

HandoverStep Giver::step() const {
  if (!partner_) return HandoverStep::kOffer;
  return engaged_ < settings_.transfer ? HandoverStep::kGrant : HandoverStep::kRelease;
}

void Receiver::Reset() {
  engaged_ = false;
  giver_.reset();
  granted_ = false;
}

void Receiver::GiveUp(bool bar) {
  Reset();
  if (bar) barred_ = settings_.bar;
}

// The nearest that offers an item within reach.
void Receiver::Begin(std::span<const HeardMessage> heard) {
  double nearest = settings_.keep_reach;
  for (const HeardMessage& one : heard) {
    if (one.message.step != HandoverStep::kOffer || one.range > nearest) continue;
    nearest = one.range;
    giver_ = one.message.self;
  }
  unheard_ = 0;
}

void Receiver::Listen(bool at_carrier, std::span<const HeardMessage> heard) {
  barred_ = std::max(0, barred_ - 1);
  if (!engaged_) {
    if (!at_carrier || barred()) return;
    engaged_ = true;
    granted_ = false;
    waited_ = 0;
  }
  ++waited_;
  if (!giver_) {
    Begin(heard);
    if (giver_) return;
    if (!at_carrier) return GiveUp(false);
    if (waited_ > settings_.answer) GiveUp(true);
    return;
  }
  const auto answer = std::find_if(heard.begin(), heard.end(), [&](const HeardMessage& one) {
    return one.message.from_robot && one.message.self == *giver_ && one.range <= settings_.keep_reach;
  });
  if (answer == heard.end()) {
    if (++unheard_ > settings_.silence) GiveUp(false);
    return;
  }
  unheard_ = 0;
  const HandoverStep step = answer->message.step;
  if (step == HandoverStep::kGrant || step == HandoverStep::kRelease) {
    if (answer->message.partner != self_) return GiveUp(false);
    if (!granted_) waited_ = 0;
    granted_ = true;
    if (waited_ > settings_.transfer + 2 * settings_.answer) GiveUp(true);
  } else if (step != HandoverStep::kOffer || granted_) {
    GiveUp(false);  // it has gone on, or has given up on this robot
  } else if (waited_ > settings_.answer) {
    GiveUp(true);
  }
}

}  // namespace gauntlet::controllers
