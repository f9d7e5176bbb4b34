// Several seeds as people write them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gauntlet {

// "1..20" or "1,5,9"; nothing when the text is neither, or has more than `most` of them.
std::optional<std::vector<std::uint64_t>> ParseSeedList(const std::string& text, std::size_t most);

}  // namespace gauntlet
