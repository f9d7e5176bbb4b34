// What the codecs of specs and of results share (run_codec.h).
#pragma once

#include <string>
#include <utility>

#include "base/result.h"
#include "sim/geometry/vec2.h"

namespace gauntlet::proto {

inline Error Corrupt(std::string what) {
  return {ErrorKind::kCorrupt, std::move(what)};
}

// `Message`: v1::Pose, which is not named here: its header is heavy.
template <typename Message>
void PoseToProto(const sim::Pose& pose, Message& message) {
  message.set_x(pose.position.x());
  message.set_y(pose.position.y());
  message.set_heading(pose.heading);
}

}  // namespace gauntlet::proto
