#include "proto/golden_hashes.h"

#include <fmt/format.h>

#include <charconv>
#include <sstream>

namespace gauntlet::proto {

std::string WriteGoldenHashes(const GoldenHashes& hashes) {
  std::string text;
  for (const auto& [controller, hash] : hashes) text += fmt::format("{} {:016x}\n", controller, hash);
  return text;
}

Result<GoldenHashes> ReadGoldenHashes(const std::string& text) {
  GoldenHashes hashes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t space = line.find(' ');
    const std::string digits = space == std::string::npos ? "" : line.substr(space + 1);
    std::uint64_t hash = 0;
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, hash, 16);
    if (space == 0 || digits.size() != 16 || error != std::errc() || stop != end) {
      return Error{
          ErrorKind::kCorrupt,
          fmt::format("'{}' is no controller's name and golden hash of 16 hexadecimal digits", line)};
    }
    hashes[line.substr(0, space)] = hash;
  }
  if (hashes.empty()) return Error{ErrorKind::kCorrupt, "there is no golden hash"};
  return hashes;
}

std::vector<std::string> ControllersOf(const GoldenHashes& hashes) {
  std::vector<std::string> names;
  for (const auto& [controller, hash] : hashes) names.push_back(controller);
  return names;
}

std::optional<GoldenDifference> FirstDifference(const GoldenHashes& needed, const GoldenHashes& offered) {
  for (const auto& [controller, hash] : needed) {
    const auto found = offered.find(controller);
    if (found == offered.end()) return GoldenDifference{controller, hash, std::nullopt};
    if (found->second != hash) return GoldenDifference{controller, hash, found->second};
  }
  return std::nullopt;
}

}  // namespace gauntlet::proto
