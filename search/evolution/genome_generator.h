// Random test cases by the rules of thesis 3.2.1: genes are drawn one after another, each redrawn until it
// breaks no validity rule, and the whole case starts anew when one gene cannot be placed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "base/result.h"
#include "search/experiment/experiment.h"
#include "sim/arena/test_case.h"
#include "sim/arena/validity.h"
#include "sim/random/random_stream.h"

namespace gauntlet {

// What a gene of a random case comes of: the first gene that was drawn for it, and the key of the stream of
// those that are drawn where that one cannot be placed.
struct GeneDraw {
  sim::ObstacleGene first;
  std::uint64_t others = 0;
};

// Draws genes and whole test cases. Immutable; every draw is a function of the stream it is given.
class GenomeGenerator {
 public:
  // After so many fresh starts the ranges are held to be too tight for any case.
  static constexpr int kMaxRestarts = 100;

  // `spec` must have passed CheckGenomeSpec. `arena_without_obstacles` gives sides and walls.
  GenomeGenerator(const GenomeSpec& spec, const sim::TestCase& arena_without_obstacles,
                  const sim::ArenaRequirements& requirements);

  // One gene, uniform in the ranges: on the grid of `step` metres (the thesis' files carry one decimal) or
  // continuous, and turned by whole degrees; with the shares asked for moving, at whole mm/s, and lit. It may
  // break validity rules.
  sim::ObstacleGene RandomGene(sim::RandomStream& random) const;

  // A valid case. Error: the arena breaks a rule without any obstacle; or no case was found in kMaxRestarts
  // starts, and the message names the ranges.
  Result<sim::TestCase> RandomTestCase(sim::RandomStream& random) const;

  GeneDraw DrawGene(sim::RandomStream& random) const;
  // A gene near this one: its place, sizes and angle moved by up to the share `reach` of their ranges, in (0,
  // .5], and turned back at their ends, so that the way back is as probable. Motion and light stay.
  sim::ObstacleGene NearGene(sim::ObstacleGene gene, double reach, sim::RandomStream& random) const;
  // The valid case that comes of these draws, a function of them: when draws are random, the case has the
  // distribution of RandomTestCase. `draws`: spec().genes of them. Error: as RandomTestCase.
  Result<sim::TestCase> CaseOf(std::span<const GeneDraw> draws) const;

  // The arena with these obstacles.
  sim::TestCase WithObstacles(sim::Genome genome) const;
  // Whether a genome breaks no validity rule in this arena.
  bool Valid(const sim::Genome& genome) const;

  const GenomeSpec& spec() const { return spec_; }

 private:
  // A centre, uniform in the places.
  sim::Vec2 DrawPlace(sim::RandomStream& random) const;
  void SetInMotion(sim::RandomStream& random, sim::ObstacleGene& gene) const;
  // Nothing when a gene found no place in tries_per_gene draws. `append` puts it into the arena, or says why
  // not; `source` gives a gene for a place in the genome.
  template <typename Append, typename Source>
  std::optional<sim::Genome> TryGenome(const Append& append, Source& source) const;
  template <typename Source>
  std::optional<sim::Genome> TryGenome(Source& source) const;

  GenomeSpec spec_;
  sim::TestCase arena_;
  sim::ArenaRequirements requirements_;
  sim::IncrementalValidity empty_;  // no obstacle yet
};

}  // namespace gauntlet
