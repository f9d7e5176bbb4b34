// What writing and reading .argos files have in common: the element that ARGoS does not read, in which a file
// of ours keeps what ARGoS has no words for.
//
//   <gauntlet seed="1234567890123" spawn_area="2,2,3,3">
//     <obstacle id="obstacle_2" path="0.5,0 0.5,1" speed="0.02" light="red"/>
//   </gauntlet>
#pragma once

#include <numbers>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace gauntlet {

inline constexpr const char* kOwnElement = "gauntlet";

// Degrees with so many digits that HeadingOf gives back the very same number; ARGoS reads the nearest double.
inline std::string DegreesText(double heading) {
  return fmt::format("{:.21g}", static_cast<long double>(heading) * 180.0L / std::numbers::pi_v<long double>);
}
// rad of degrees.
inline double HeadingOf(long double degrees) {
  return static_cast<double>(degrees * std::numbers::pi_v<long double> / 180.0L);
}

// Of the walls at +y, -y, +x, -x.
inline constexpr std::string_view kWallIds[] = {"wall_north", "wall_south", "wall_east", "wall_west"};

inline std::string ObstacleId(std::size_t number) {
  return fmt::format("obstacle_{}", number);
}

}  // namespace gauntlet
