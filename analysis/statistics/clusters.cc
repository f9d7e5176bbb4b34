#include "analysis/statistics/clusters.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace gauntlet::analysis {
namespace {

// Groups, each named by its first thing, and how far their farthest things are apart.
class Groups {
 public:
  Groups(std::size_t count, const std::function<double(std::size_t, std::size_t)>& distance)
      : group_of_(count), alive_(count, true), diameters_(count * count) {
    std::iota(group_of_.begin(), group_of_.end(), std::size_t{0});
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < a; ++b) At(a, b) = At(b, a) = distance(a, b);
    }
  }

  double& At(std::size_t a, std::size_t b) { return diameters_[a * group_of_.size() + b]; }

  // The nearest other group; of equally near ones `preferred`, else the first. `group` itself when there is
  // no other within `most`.
  std::size_t NearestTo(std::size_t group, std::size_t preferred, double most) {
    std::size_t nearest = group;
    double best = most;
    for (std::size_t other = 0; other < group_of_.size(); ++other) {
      if (!alive_[other] || other == group) continue;
      const double diameter = At(group, other);
      if (diameter < best || (diameter == best && (nearest == group || other == preferred))) {
        best = diameter;
        nearest = other;
      }
    }
    return nearest;
  }

  void Join(std::size_t a, std::size_t b) {
    const auto [first, second] = std::minmax(a, b);
    alive_[second] = false;
    for (std::size_t& group : group_of_) {
      if (group == second) group = first;
    }
    for (std::size_t other = 0; other < group_of_.size(); ++other) {
      if (other == first) continue;
      At(first, other) = At(other, first) = std::max(At(first, other), At(second, other));
    }
  }

  const std::vector<std::size_t>& group_of() const { return group_of_; }

 private:
  std::vector<std::size_t> group_of_;
  std::vector<bool> alive_;
  std::vector<double> diameters_;
};

}  // namespace

std::vector<std::size_t> GroupByDistance(std::size_t count,
                                         const std::function<double(std::size_t a, std::size_t b)>& distance,
                                         double most) {
  Groups groups(count, distance);
  // Two groups that are each other's nearest may be joined before any others: with complete linkage nothing
  // that is joined later comes nearer to them. So a chain of nearest groups is followed until it turns back.
  std::vector<std::size_t> chain;
  for (std::size_t start = 0; start < count; ++start) {
    if (groups.group_of()[start] != start) continue;
    chain = {start};
    while (!chain.empty()) {
      const std::size_t last = chain.back();
      const std::size_t before = chain.size() > 1 ? chain[chain.size() - 2] : count;
      const std::size_t nearest = groups.NearestTo(last, before, most);
      if (nearest == last) {
        chain.pop_back();
      } else if (nearest == before) {
        chain.resize(chain.size() - 2);
        groups.Join(last, nearest);
        if (chain.empty() && groups.group_of()[start] == start) chain = {start};
      } else {
        chain.push_back(nearest);
      }
    }
  }
  std::map<std::size_t, std::size_t> numbers;
  std::vector<std::size_t> group_of;
  for (const std::size_t group : groups.group_of())
    group_of.push_back(numbers.try_emplace(group, numbers.size()).first->second);
  return group_of;
}

}  // namespace gauntlet::analysis
