// The worker's side of the wire: protocol.proto's envelopes to plain structs and back.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "proto/messages.h"

namespace gauntlet::worker {

// No message is larger, in either direction (proto/README.md).
inline constexpr std::size_t kMaxMessageBytes = 16u << 20;
// What a result may take of it: the rest is the envelope's.
inline constexpr std::size_t kMaxResultBytes = kMaxMessageBytes - 64u * 1024u;

// One frame from the master. Error (kInvalidInput): not an envelope, a message that only workers send or that
// this version does not know, or a value outside its range; the message names it.
Result<MasterMessage> DecodeMasterMessage(std::string_view frame);

// One frame for the master.
std::string EncodeWorkerMessage(const WorkerMessage& message);

}  // namespace gauntlet::worker
