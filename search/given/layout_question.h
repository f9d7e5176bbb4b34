// A question about one test case that runs of some of its obstacles answer: which are needed, what each does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "search/failure_tally.h"
#include "sim/arena/genome.h"

namespace gauntlet {

// Some of a case's obstacles.
struct Layout {
  std::vector<std::size_t> kept;  // which of the case's, from 0, ascending
  sim::Genome obstacles;          // these, as they stand now

  bool operator==(const Layout&) const = default;
};
// `obstacle` is one of those that are kept.
Layout Without(const Layout& layout, std::size_t obstacle);
Layout AllOf(const sim::Genome& obstacles);

// What became of runs of one layout.
struct LayoutRuns {
  FailureTally tally;
  std::vector<sim::Vec2> places;  // m: where failures happened, of those that have a place
  // How often robots were at each of the layout's obstacles; empty when nobody has counted.
  std::vector<std::uint64_t> visits;

  void Add(const LayoutRuns& more);
};

// Pure: it is told what became of runs, and names the next ones.
class LayoutQuestion {
 public:
  virtual ~LayoutQuestion() = default;
  // The layout to simulate now, and how often, with seeds that it was never simulated with; 0 = it is known.
  // The first one is the case as it is.
  virtual const Layout& layout() const = 0;
  virtual int runs() const = 0;
  // All these runs of `layout()`.
  virtual void Tell(const LayoutRuns& runs) = 0;
};

}  // namespace gauntlet
