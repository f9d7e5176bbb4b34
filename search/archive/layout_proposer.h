// What an archive search may try next, in the light of what its archive holds and lacks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "search/archive/archive_emitters.h"
#include "search/archive/failure_archive.h"
#include "search/search_setup.h"

namespace gauntlet {

// Where a layout came from. Saved states depend on the order.
enum class Emitter : std::uint8_t { kRandom, kNearest, kWithout, kMirrored, kAcross, kJittered, kRecheck };
inline constexpr std::size_t kEmitters = 7;
std::string_view NameOf(Emitter emitter);

// A layout that a line may begin with.
struct Proposal {
  Emitter emitter = Emitter::kRandom;
  sim::Genome obstacles;
  IndividualId parent = 0;               // 0 = none
  std::optional<std::size_t> cell = {};  // that what follows is to become the smallest of
};

// Proposals are nothing when there is nothing to begin with, or when no valid layout was found.
class LayoutProposer {
 public:
  // Keeps references to all that it is given. `places`: the axes of the archive are the coordinates of a
  // place.
  LayoutProposer(const SearchSetup& setup, const GenomeGenerator& generator, bool places,
                 FailureArchive& archive);

  // Whether there is a way that obstacles can stand across.
  bool HasWay() const { return way_.start != way_.goal; }

  Proposal Random(sim::RandomStream& random) const;
  // An elite on the other side of the way, where it would win a cell; of places only. Marks it in the
  // archive.
  std::optional<Proposal> Mirrored();
  // Obstacles in a row; `needed`: with no more of them than win a cell; one alone is nearly as long as any
  // may be.
  std::optional<Proposal> Across(bool needed, sim::RandomStream& random) const;
  // An elite without one of its obstacles, changed a little; there has to be an elite.
  std::optional<Proposal> Jittered(sim::RandomStream& random) const;

  // A layout whose obstacles are all changed a little.
  std::optional<Proposal> Changed(const Individual& individual, sim::RandomStream& random) const;

  // A few obstacles of a layout that failed there, the most suspect ones first.
  std::vector<sim::Genome> PartsNear(const sim::Genome& obstacles, const Descriptor& failure) const;
  // All but one obstacle, first without the one that is least suspect.
  std::vector<sim::Genome> PartsWithoutOne(const sim::Genome& obstacles, const Descriptor& failure) const;

 private:
  // What could be won along the shortest way through the arena.
  double Promise(const sim::TestCase& test_case) const;
  std::optional<Proposal> Needed(sim::RandomStream& random) const;
  std::uint32_t MostAcross() const;  // obstacles in a row
  // The most obstacles that would win a cell, which is drawn from those that hold none or more than one. 0:
  // there is none.
  std::uint32_t DrawMostAcross(sim::RandomStream& random) const;
  const Finding& DrawElite(sim::RandomStream& random) const;
  const Finding* DrawEliteOfOne(sim::RandomStream& random) const;  // nullptr: there is none
  // A place on the way.
  sim::Vec2 DrawPlace(sim::RandomStream& random) const;
  // The obstacles in the order in which they are probably needed.
  std::vector<std::size_t> Order(const sim::Genome& obstacles, const Descriptor& failure) const;

  const GenomeGenerator& generator_;
  const bool places_;
  const Way way_;
  const sim::ArenaRequirements& requirements_;
  FailureArchive& archive_;
};

}  // namespace gauntlet
