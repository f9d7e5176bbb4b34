// Genomes with genes of all kinds: standing, moving, lit and both; for round trips.
#pragma once

#include <rapidcheck.h>

#include "sim/arena/genome.h"

namespace gauntlet::sim {

inline double ArbitraryCoordinate() {
  return *rc::gen::inRange(-3000, 3001) / 1000.0;
}

inline ObstacleGene ArbitraryGene() {
  ObstacleGene gene;
  gene.x = ArbitraryCoordinate();
  gene.y = ArbitraryCoordinate();
  gene.length = *rc::gen::inRange(1, 2000) / 1000.0;
  gene.width = *rc::gen::inRange(1, 2000) / 1000.0;
  gene.orientation_deg = *rc::gen::inRange(0, 360);
  if (*rc::gen::arbitrary<bool>()) {
    gene.speed = *rc::gen::inRange(1, 51) / 1000.0;
    for (int points = *rc::gen::inRange(1, 5); points > 0; --points) {
      const double x = ArbitraryCoordinate();
      gene.path.emplace_back(x, ArbitraryCoordinate());
    }
  }
  if (*rc::gen::arbitrary<bool>()) gene.light = static_cast<Color>(*rc::gen::inRange(1, 9));
  return gene;
}

inline Genome ArbitraryGenome() {
  Genome genome;
  for (int genes = *rc::gen::inRange(0, 9); genes > 0; --genes) genome.push_back(ArbitraryGene());
  return genome;
}

}  // namespace gauntlet::sim
