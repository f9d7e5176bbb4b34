// What the robots of a swarm see or hear: a list for each, side by side in memory that is kept.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace gauntlet::sim {

template <typename Seen>
class SeenLists {
 public:
  // Allocates nothing later while all lists together hold at most `room`.
  SeenLists(std::size_t robots, std::size_t room) : all_(room), first_(robots + 1) {}

  // The lists are made anew, robot by robot.
  void Clear() { count_ = 0; }
  // The place where the list of the next robot begins, with room for `most`.
  Seen* Begin(std::size_t robot, std::size_t most) {
    first_[robot] = count_;
    if (all_.size() < count_ + most) all_.resize(std::max(count_ + most, 2 * all_.size()));
    return all_.data() + count_;
  }
  // It ends before `end`.
  void End(std::size_t robot, const Seen* end) {
    count_ = static_cast<std::size_t>(end - all_.data());
    first_[robot + 1] = count_;
  }
  std::span<Seen> Of(std::size_t robot) {
    return std::span(all_).subspan(first_[robot], first_[robot + 1] - first_[robot]);
  }

 private:
  std::vector<Seen> all_;
  std::size_t count_ = 0;
  std::vector<std::size_t> first_;  // where the list of a robot begins, and the end of the last
};

}  // namespace gauntlet::sim
