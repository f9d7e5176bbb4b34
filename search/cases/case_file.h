// Test cases from files, whatever their format.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/result.h"
#include "proto/case_json.h"
#include "sim/arena/test_case.h"

namespace gauntlet {

// A test case out of a file.
struct LoadedCase {
  sim::TestCase test_case;
  std::string notice;  // one line, without the file's name: what was changed and ignored; "" when nothing
  std::optional<proto::CaseLineage> lineage = {};  // of a case that a command made out of another one
};

// Reads a case file: .json (proto/README.md, or a file of a corpus, of which only the case counts) or .argos
// by its extension, any other by its content. A case without a name is named after the file. Error: no such
// file, larger than 16 MiB, or "FILE:LINE:COLUMN:
// ...".
Result<LoadedCase> LoadCase(const std::filesystem::path& path);

// Reads the environment out of an ARGoS3 experiment file (.argos): arena, boxes, number and start of the
// foot-bots. `file_name` stands in messages and becomes the case's name.
//
// - Coordinates are relative to the arena's centre. Boxes that stand where our walls are (centre on the
//   arena's edge, length of the side, within 1 cm) become the walls; all others become obstacles in file
//   order.
// - Foot-bots that stand in the file by themselves give the start poses. <distribute> of foot-bots gives the
//   number and, with method="uniform", the spawn area.
// - What WriteArgos has written gives the very same test case, also what ARGoS has no words for.
// - Movable boxes become fixed and all boxes count as full height; the notice says so.
// - Error "FILE:LINE:COLUMN: ..." for malformed XML, a missing arena, values that are no numbers, boxes
//   rotated about another axis than z and cylinders.
Result<LoadedCase> ParseArgos(const std::string& text, const std::string& file_name);

}  // namespace gauntlet
