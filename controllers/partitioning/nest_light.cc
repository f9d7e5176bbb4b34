#include "controllers/partitioning/nest_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

constexpr double kSpacing = 2.0 * sim::kPi / sim::foot_bot::kLightSensors;
constexpr double kHalfWidth = sim::kPi / 2.0;  // a sensor reads nothing from farther aside

}  // namespace

std::optional<NestDirection> ReadLamp(const std::array<double, sim::foot_bot::kLightSensors>& readings,
                                      const Lamp& lamp) {
  const std::size_t count = readings.size();
  const auto brightest = static_cast<std::size_t>(
      std::distance(readings.begin(), std::max_element(readings.begin(), readings.end())));
  if (readings[brightest] <= 0.0) return std::nullopt;
  const std::size_t next = (brightest + 1) % count;
  const std::size_t previous = (brightest + count - 1) % count;
  // The lamp is between sensors `right` and `left`, which is the next one counter-clockwise.
  const bool to_the_left = readings[next] >= readings[previous];
  const std::size_t right = to_the_left ? brightest : previous;
  const std::size_t left = to_the_left ? next : brightest;
  const double brightness = (readings[right] + readings[left]) / (2.0 - kSpacing / kHalfWidth);
  const double past_right = (kSpacing - kHalfWidth * (readings[right] - readings[left]) / brightness) / 2.0;
  NestDirection nest;
  nest.bearing = sim::WrapAngle((static_cast<double>(right) + 0.5) * kSpacing + past_right);
  const double slant = -0.5 * lamp.intensity * sim::Log(brightness);
  nest.distance = std::sqrt(std::max(0.0, slant * slant - lamp.height * lamp.height));
  return nest;
}

}  // namespace gauntlet::controllers
