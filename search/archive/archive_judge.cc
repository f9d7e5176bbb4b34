#include "search/archive/archive_judge.h"

#include <algorithm>
#include <iterator>

namespace gauntlet {
namespace {

// To take the place of an elite of as many obstacles: of many that are tried some fail three times by luck.
constexpr int kFailuresToShorten = 5;
constexpr int kMaxRuns = 8;                   // of an elite; then it is known well enough
constexpr double kReliable = 0.6;             // of its runs an elite has to be expected to fail
constexpr std::ptrdiff_t kMostElsewhere = 1;  // failures of a layout outside its cell, when it is admitted
constexpr std::ptrdiff_t kEnoughWithOneElsewhere = 5;

}  // namespace

Race ArchiveJudge::OfRuns(const Finding& finding) {
  const FailureTally& tally = finding.tally;
  const int passes = tally.passes + tally.errors;
  // Without a failure that can be described there is nothing to say in which cell it belongs.
  if (tally.failures == 0 || passes >= 2 || finding.failures.empty()) return Race::kDrop;
  if ((tally.failures >= kFewestFailures && passes == 0) || tally.failures >= 4) return Race::kAdmit;
  return Race::kOpen;
}

Race ArchiveJudge::InItsCell(const Finding& finding, bool late) const {
  const std::size_t cell = archive_.grid().CellOf(finding.Middle());
  if (!Matters(cell, finding.size())) return Race::kDrop;
  Race race = OfRuns(finding);
  if (race == Race::kAdmit) race = Place(finding, cell);
  if (race == Race::kAdmit && by_cell_) race = Shortening(finding, archive_.EliteOf(cell), late);
  return race;
}

bool ArchiveJudge::Matters(std::size_t cell, const LayoutSize& size) const {
  return !by_cell_ || archive_.WouldWin(cell, size);
}

// Whether a layout that fails often enough does so in one cell.
Race ArchiveJudge::Place(const Finding& finding, std::size_t cell) const {
  const auto elsewhere = std::ranges::count_if(
      finding.failures, [&](const Descriptor& failure) { return archive_.grid().CellOf(failure) != cell; });
  if (elsewhere == 0) return Race::kAdmit;
  if (elsewhere > kMostElsewhere) return Race::kDrop;
  return std::ssize(finding.failures) >= kEnoughWithOneElsewhere ? Race::kAdmit : Race::kOpen;
}

Race ArchiveJudge::Shortening(const Finding& finding, const Finding* elite, bool late) const {
  if (elite == nullptr || elite->size().obstacles != finding.size().obstacles) return Race::kAdmit;
  if (finding.tally.failures < kFailuresToShorten) return Race::kOpen;
  if (!late || prior_.Expected(finding.tally) >= prior_.Expected(elite->tally)) return Race::kAdmit;
  return finding.tally.runs() + finding.tally.errors < kMaxRuns ? Race::kOpen : Race::kDrop;
}

bool ArchiveJudge::Stays(const Finding& elite, bool late) const {
  const double expected = prior_.Expected(elite.tally);
  const Finding* next = archive_.EliteOf(archive_.grid().CellOf(elite.Middle()));
  const bool gives_way = late && next != nullptr && next->size().obstacles <= elite.size().obstacles &&
                         expected < kBeyondDoubt && expected < prior_.Expected(next->tally);
  return expected >= kReliable && !gives_way;
}

const Finding* ArchiveJudge::MostDoubtful(double below) const {
  const Finding* worst = nullptr;
  double least = below;
  for (const auto& [cell, shelf] : archive_.shelves()) {
    const Finding& elite = shelf.front();
    const double expected = prior_.Expected(elite.tally);
    if (elite.tally.runs() >= kMaxRuns || expected >= least) continue;
    least = expected;
    worst = &elite;
  }
  return worst;
}

}  // namespace gauntlet
