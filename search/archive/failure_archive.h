// The smallest reliable failure of each kind that a search has found: a grid over how swarms failed, and in
// each cell the test cases that fail there, the smallest first.
#pragma once

#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "controllers/failure_descriptor.h"
#include "search/failure_tally.h"
#include "search/search_algorithm.h"

namespace gauntlet {

// Fewer obstacles are smaller; of as many, those that are shorter in all.
struct LayoutSize {
  std::size_t obstacles = 0;
  double length = 0.0;  // m, sum
  auto operator<=>(const LayoutSize&) const = default;
};
LayoutSize SizeOf(const sim::Genome& obstacles);

// What a failed run showed, a value for each axis.
using Descriptor = std::vector<double>;
// The median of each axis over failures, of which there is at least one.
Descriptor MiddleOf(const std::vector<Descriptor>& failures);

class DescriptorGrid {
 public:
  explicit DescriptorGrid(std::vector<controllers::DescriptorAxis> axes) : axes_(std::move(axes)) {}

  const std::vector<controllers::DescriptorAxis>& axes() const { return axes_; }
  std::size_t cells() const;
  // Row by row: the last axis runs fastest.
  std::size_t CellOf(const Descriptor& descriptor) const;
  // The part of each axis that the cell belongs to.
  std::vector<int> PartsOf(std::size_t cell) const;
  // Nothing when the run does not report one of the metrics.
  std::optional<Descriptor> Describe(const RunOutcome& run) const;

 private:
  std::vector<controllers::DescriptorAxis> axes_;
};

// A test case with what its runs showed.
struct Finding {
  Individual individual;
  FailureTally tally;
  std::vector<Descriptor> failures;  // of runs that failed and could be described

  bool mirrored = false;  // has been an example for a layout on the other side

  LayoutSize size() const { return SizeOf(individual.test_case.obstacles); }
  // Of the failures, of which there is at least one.
  Descriptor Middle() const { return MiddleOf(failures); }
};

class FailureArchive {
 public:
  // In each cell the smallest, and what is ready to take its place should it prove unreliable.
  static constexpr std::size_t kShelf = 3;
  using Shelves = std::map<std::size_t, std::vector<Finding>>;

  explicit FailureArchive(std::vector<controllers::DescriptorAxis> axes) : grid_(std::move(axes)) {}

  const DescriptorGrid& grid() const { return grid_; }
  // By cell; no shelf is empty.
  const Shelves& shelves() const { return shelves_; }
  // The smallest of the cell; nullptr = the cell is empty.
  const Finding* EliteOf(std::size_t cell) const;
  bool WouldWin(std::size_t cell, const LayoutSize& size) const;
  // Puts the finding into the cell of its middle, unless that holds kShelf smaller ones. Whether it is the
  // smallest there.
  bool Add(Finding finding);
  // The elite was mirrored: it is not to be again.
  void SetMirrored(std::size_t cell) { shelves_.at(cell).front().mirrored = true; }
  // The finding that has this individual, which must be there.
  Finding Take(IndividualId individual);
  void Restore(Shelves shelves) { shelves_ = std::move(shelves); }

 private:
  DescriptorGrid grid_;
  Shelves shelves_;
};

}  // namespace gauntlet
