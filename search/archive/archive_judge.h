// Which layouts an archive search admits to its archive, runs again and drops.
#pragma once

#include <cstddef>

#include "search/archive/failure_archive.h"
#include "search/archive/failure_prior.h"

namespace gauntlet {

enum class Race { kOpen, kAdmit, kDrop };

class ArchiveJudge {
 public:
  // A case is admitted after so many failures at the earliest.
  static constexpr int kFewestFailures = 3;
  // Of further runs so many of an elite's are expected to fail; with fewer it is run again before anything
  // new begins.
  static constexpr double kBeyondDoubt = 0.8;

  // Keeps references to both. `by_cell`: what cannot become the smallest of its cell is of no use, and what
  // has as many obstacles as that has to be as reliable.
  ArchiveJudge(const FailureArchive& archive, const FailurePrior& prior, bool by_cell)
      : archive_(archive), prior_(prior), by_cell_(by_cell) {}

  // What the runs of a layout alone say.
  static Race OfRuns(const Finding& finding);
  // What its cell says of one that they do not drop. `late`: its reliability counts.
  Race InItsCell(const Finding& finding, bool late) const;
  // Whether it is worth knowing that a layout of this size fails in the cell.
  bool Matters(std::size_t cell, const LayoutSize& size) const;
  // Of an elite that was taken out and run again.
  bool Stays(const Finding& elite, bool late) const;
  // The elite that is expected to fail least, if that is less than `below`; nullptr: there is none.
  const Finding* MostDoubtful(double below) const;

 private:
  Race Place(const Finding& finding, std::size_t cell) const;
  Race Shortening(const Finding& finding, const Finding* elite, bool late) const;

  const FailureArchive& archive_;
  const FailurePrior& prior_;
  const bool by_cell_;
};

}  // namespace gauntlet
