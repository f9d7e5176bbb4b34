// What is wrong with a definition that no single value is to blame for.
#pragma once

#include <cstddef>
#include <optional>

#include "controllers/command/definition.h"

namespace gauntlet::controllers::command {

// What is missing, named and not there, or contradicts something else; the first in the order of the table.
// `named`: so many of its metrics, the first, are of the key `metrics`.
std::optional<Complaint> FindContradiction(const Definition& definition, std::size_t named);

}  // namespace gauntlet::controllers::command
