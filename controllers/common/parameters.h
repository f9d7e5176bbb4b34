// Reading resolved parameters.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/check.h"
#include "sim/robot/foot_bot.h"
#include "sim/run_spec.h"

namespace gauntlet::controllers {

// The value of a parameter that the registry has resolved; aborts when it is missing.
inline double GetParameter(const sim::Parameters& parameters, const char* name) {
  const auto found = parameters.find(name);
  GAUNTLET_CHECK(found != parameters.end(), std::string("unresolved parameter ") + name);
  return found->second;
}

// Seconds as the nearest number of ticks.
inline sim::Tick ToTicks(double seconds) {
  return static_cast<sim::Tick>(std::floor(seconds * sim::kTicksPerSecond + 0.5));
}

// Tables of parameters one after another.
template <typename Info, std::size_t kFirst, std::size_t kSecond>
constexpr std::array<Info, kFirst + kSecond> Joined(const std::array<Info, kFirst>& first,
                                                    const std::array<Info, kSecond>& second) {
  std::array<Info, kFirst + kSecond> all;
  std::copy(second.begin(), second.end(), std::copy(first.begin(), first.end(), all.begin()));
  return all;
}

}  // namespace gauntlet::controllers
