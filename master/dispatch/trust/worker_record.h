// What a worker has shown of itself, and what follows from it.
#pragma once

#include <cstdint>
#include <string>

namespace gauntlet {

// Plain counts, since the worker's first hello to this master.
struct WorkerRecord {
  // So many that speak against a worker, and more than speak for it, and it gets nothing more to do.
  static constexpr std::uint64_t kMostFaults = 3;
  // So many runs failed in a row, and it looks like a hole into which all work falls.
  static constexpr std::uint32_t kBlackHole = 3;
  // It gives back what waits behind a run that crashed, and says so of the crash.
  static constexpr std::uint64_t kMostReturned = 1024;
  // So many runs failed in a row while others finished nearly all of theirs, and its failures are its own.
  static constexpr std::uint64_t kMostInARow = 8;
  // Failures of a worker count for a verdict while at most one of so many of its runs speaks against it.
  static constexpr std::uint64_t kFinishedForEachFault = 10;

  std::uint64_t finished = 0;      // runs of which it brought a result
  std::uint64_t failed = 0;        // runs that failed on it of themselves, as it says
  std::uint64_t contradicted = 0;  // of these, that another worker finished
  std::uint64_t strikes = 0;       // answers that could not be read, or to leases that it does not have
  std::uint64_t outside = 0;  // runs that were ended from outside on it, and that another worker finished
  // Runs that it kept so long that others got them too, and finished them first, since it last said
  // something.
  std::uint64_t hoarded = 0;
  // Leases that it gave back without a word about the run, since it last said one.
  std::uint64_t returned = 0;
  // Different runs that failed on it since it finished one, or since another worker failed one of them too.
  std::uint32_t failed_in_a_row = 0;
  // Runs that failed on it in a row, when others hardly failed any meanwhile; else 0. Only where nobody can
  // contradict it, because a run's first ending counts.
  std::uint64_t failed_alone = 0;
  bool quarantined = false;

  std::uint64_t faults() const { return contradicted + strikes; }
  bool black_hole() const { return failed_in_a_row >= kBlackHole || returned >= kMostReturned; }
  bool tried() const { return finished + failed > 0; }
  // Has it worked well enough for its failures to be believed?
  bool trusted() const {
    return !quarantined && finished > 0 && kFinishedForEachFault * faults() <= finished;
  }
  bool deserves_quarantine() const {
    const bool brings_nothing =
        finished == 0 && (outside >= kMostFaults || hoarded >= kMostFaults || returned >= kMostReturned);
    return !quarantined &&
           (brings_nothing || failed_alone > 0 || (faults() >= kMostFaults && faults() > finished));
  }
};

// What speaks for and against the worker, in a line for people.
std::string InWords(const WorkerRecord& record);

}  // namespace gauntlet
