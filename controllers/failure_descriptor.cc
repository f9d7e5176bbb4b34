#include "controllers/failure_descriptor.h"

#include <algorithm>

namespace gauntlet::controllers {

std::optional<double> ReportedValue(MetricValues metrics, std::string_view name) {
  const auto metric = std::ranges::find(metrics, name, &std::pair<std::string, double>::first);
  return metric == metrics.end() ? std::nullopt : std::optional(metric->second);
}

std::size_t FailureDescriptor::KindOf(MetricValues metrics) const {
  const auto kind = std::ranges::find_if(kinds, [&](const FailureKind& one) {
    const std::optional<double> value = ReportedValue(metrics, one.metric);
    return value && *value <= one.at_most;
  });
  return static_cast<std::size_t>(kind - kinds.begin());
}

std::optional<sim::Vec2> FailureDescriptor::PlaceOf(MetricValues metrics) const {
  if (!place) return std::nullopt;
  const double x = ReportedValue(metrics, place->x).value_or(kNowhere);
  const double y = ReportedValue(metrics, place->y).value_or(kNowhere);
  return x == kNowhere || y == kNowhere ? std::nullopt : std::optional<sim::Vec2>({x, y});
}

bool FailureDescriptor::ArePlaces(std::span<const DescriptorAxis> given) const {
  return place && given.size() == 2 && given[0].metric == place->x && given[1].metric == place->y;
}

const FailureType* FailureTypes::Find(int type) const {
  const auto found = std::ranges::find(types, type, &FailureType::type);
  return found == types.end() ? nullptr : &*found;
}

}  // namespace gauntlet::controllers
