#include "proto/run_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "base/parse_number.h"

namespace gauntlet::proto {
namespace {

constexpr RunId kSequences = RunId{1} << kSequenceBits;
constexpr RunId kSearches = RunId{1} << (64 - kSequenceBits);

}  // namespace

std::string RunText(RunId run) {
  return run < kSequences ? fmt::format("{}", run) : RunAddress(run);
}

std::string RunAddress(RunId run) {
  return fmt::format("{}:{}", (run >> kSequenceBits) + 1, run & (kSequences - 1));
}

std::string RunFileName(RunId run) {
  std::string name = "run-" + RunText(run);
  std::ranges::replace(name, ':', '-');
  return name;
}

std::string RunRanges(std::vector<RunId> runs) {
  std::ranges::sort(runs);
  constexpr int kMostRanges = 10;
  std::string text;
  int ranges = 0;
  for (std::size_t i = 0; i < runs.size();) {
    if (ranges++ == kMostRanges) return fmt::format("{} and {} more runs", text, runs.size() - i);
    std::size_t last = i;
    while (last + 1 < runs.size() && runs[last + 1] == runs[last] + 1) ++last;
    text += fmt::format("{}{}", i == 0 ? "" : ", ", RunText(runs[i]));
    if (last > i) text += fmt::format("{}{}", last == i + 1 ? ", " : " to ", RunText(runs[last]));
    i = last + 1;
  }
  return text;
}

std::optional<RunId> ParseRun(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) {
    const auto id = ParseNumber<RunId>(text);
    return id && *id >= 1 ? id : std::nullopt;
  }
  const auto search = ParseNumber<std::uint64_t>(text.substr(0, colon));
  const auto number = ParseNumber<std::uint64_t>(text.substr(colon + 1));
  if (!search || !number || *search < 1 || *search > kSearches || *number < 1 || *number >= kSequences)
    return std::nullopt;
  return ((*search - 1) << kSequenceBits) + *number;
}

}  // namespace gauntlet::proto
