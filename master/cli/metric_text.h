// Metrics of a run as people read them: with their units, and "none" where there was nothing to measure.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gauntlet::master {

// Name and value as text, in the order given. Angles are shown in degrees. A metric that the scenario does
// not describe is shown as its bare number.
std::vector<std::pair<std::string, std::string>> MetricTexts(
    std::string_view scenario, const std::vector<std::pair<std::string, double>>& metrics);

}  // namespace gauntlet::master
