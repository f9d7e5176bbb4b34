// The one place where the envelopes of protocol.proto meet plain structs. A frame holds one envelope.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "proto/messages.h"

namespace gauntlet::proto {

std::string EncodeMasterMessage(const MasterMessage& message);
std::string EncodeWorkerMessage(const WorkerMessage& message);

// A frame from the master, read strictly. Error (kInvalidInput): not an envelope, a message that only workers
// send or that this version does not know, or a value outside its range; the message names it.
Result<MasterMessage> DecodeMasterMessage(std::string_view frame);

// A frame from a peer of the master's, read leniently: what its values mean is judged by who knows the
// campaign. Of a longer stderr_tail the end is kept; a kind of failure that this version does not know is
// kExternal. Error (kInvalidInput): not an envelope, or a message that only masters send or that this version
// does not know.
Result<WorkerMessage> DecodeWorkerMessage(std::string_view frame);

}  // namespace gauntlet::proto
