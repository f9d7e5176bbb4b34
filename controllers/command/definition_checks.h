// What is wrong with a definition that no single value is to blame for.
#pragma once

#include <optional>

#include "controllers/command/definition.h"

namespace gauntlet::controllers::command {

// What is missing, named and not there, or contradicts something else; the first in the order of the table.
std::optional<Complaint> FindContradiction(const Definition& definition);

}  // namespace gauntlet::controllers::command
