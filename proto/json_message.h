// The proto3 JSON mapping for reading: fills a protobuf message from a located JSON document, so that every
// error names file, line and column.
#pragma once

#include <string>

#include "proto/json_document.h"

namespace google::protobuf {
class Message;
}

namespace gauntlet::proto {

// Keys may be the field's name in the schema (orientation_deg) or its JSON name (orientationDeg); numbers may
// be quoted; null leaves the default. Stricter than the mapping demands: numbers must be finite. Supports the
// field types of proto/run.proto's TestCase. Error: an unknown key (with the nearest known one) or a value
// of the wrong kind.
Status FillMessage(const JsonValue& json, const std::string& file_name, google::protobuf::Message& message);

}  // namespace gauntlet::proto
