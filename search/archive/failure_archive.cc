#include "search/archive/failure_archive.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace gauntlet {

LayoutSize SizeOf(const sim::Genome& obstacles) {
  LayoutSize size{.obstacles = obstacles.size()};
  for (const sim::ObstacleGene& gene : obstacles) size.length += gene.length;
  return size;
}

std::size_t DescriptorGrid::cells() const {
  std::size_t cells = 1;
  for (const controllers::DescriptorAxis& axis : axes_) cells *= static_cast<std::size_t>(axis.parts);
  return cells;
}

std::size_t DescriptorGrid::CellOf(const Descriptor& descriptor) const {
  GAUNTLET_CHECK(descriptor.size() == axes_.size(), "a value for each axis");
  std::size_t cell = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const controllers::DescriptorAxis& axis = axes_[i];
    const double part = std::floor((descriptor[i] - axis.min) / (axis.max - axis.min) * axis.parts);
    cell = cell * static_cast<std::size_t>(axis.parts) +
           static_cast<std::size_t>(std::clamp(part, 0.0, axis.parts - 1.0));
  }
  return cell;
}

std::vector<int> DescriptorGrid::PartsOf(std::size_t cell) const {
  std::vector<int> parts(axes_.size());
  for (std::size_t i = axes_.size(); i-- > 0;) {
    const auto count = static_cast<std::size_t>(axes_[i].parts);
    parts[i] = static_cast<int>(cell % count);
    cell /= count;
  }
  return parts;
}

std::optional<Descriptor> DescriptorGrid::Describe(const RunOutcome& run) const {
  Descriptor descriptor;
  for (const controllers::DescriptorAxis& axis : axes_) {
    const auto metric = std::ranges::find(run.metrics, axis.metric, &std::pair<std::string, double>::first);
    if (metric == run.metrics.end() || !std::isfinite(metric->second)) return std::nullopt;
    descriptor.push_back(metric->second);
  }
  return descriptor;
}

Descriptor MiddleOf(const std::vector<Descriptor>& failures) {
  GAUNTLET_CHECK(!failures.empty(), "a middle of something");
  Descriptor middle;
  for (std::size_t axis = 0; axis < failures.front().size(); ++axis) {
    std::vector<double> values;
    for (const Descriptor& failure : failures) values.push_back(failure[axis]);
    const auto half = values.begin() + std::ssize(values) / 2;
    std::ranges::nth_element(values, half);
    middle.push_back(*half);
  }
  return middle;
}

const Finding* FailureArchive::EliteOf(std::size_t cell) const {
  const auto shelf = shelves_.find(cell);
  return shelf == shelves_.end() ? nullptr : &shelf->second.front();
}

bool FailureArchive::WouldWin(std::size_t cell, const LayoutSize& size) const {
  const Finding* elite = EliteOf(cell);
  return elite == nullptr || size < elite->size();
}

bool FailureArchive::Add(Finding finding) {
  std::vector<Finding>& shelf = shelves_[grid_.CellOf(finding.Middle())];
  const auto place = std::ranges::upper_bound(shelf, finding.size(), {}, &Finding::size);
  const bool smallest = place == shelf.begin();
  shelf.insert(place, std::move(finding));
  if (shelf.size() > kShelf) shelf.pop_back();
  return smallest;
}

Finding FailureArchive::Take(IndividualId individual) {
  for (auto shelf = shelves_.begin(); shelf != shelves_.end(); ++shelf) {
    for (auto found = shelf->second.begin(); found != shelf->second.end(); ++found) {
      if (found->individual.id != individual) continue;
      Finding taken = std::move(*found);
      shelf->second.erase(found);
      if (shelf->second.empty()) shelves_.erase(shelf);
      return taken;
    }
  }
  GAUNTLET_CHECK(false, "the archive holds no such individual");
  return {};
}

}  // namespace gauntlet
