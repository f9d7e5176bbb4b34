// The obstacles of a test case as the genetic algorithm sees them, and their canonical encoding.
#pragma once

#include <vector>

#include "base/canonical_encoder.h"
#include "sim/arena/color.h"
#include "sim/geometry/oriented_box.h"

namespace gauntlet::sim {

// One obstacle (thesis 3.2.1: a "single descriptor"). It may move slowly and carry lights that robots take
// for flockmates (thesis 7.4); the shipped experiments have none such.
struct ObstacleGene {
  double x = 0.0;                // m, centre
  double y = 0.0;                // m, centre
  double length = 0.0;           // m
  double width = 0.0;            // m
  double orientation_deg = 0.0;  // degrees counter-clockwise, [0, 360); degrees, because the thesis' genes
                                 // are whole degrees and a case file must give back the very same number
  // Places that its centre visits one after the other, m, then back the same way to (x, y), again and again.
  // Empty: it stands. It never turns.
  std::vector<Vec2> path = {};
  double speed = 0.0;           // m/s along the path; 0 to kMaxObstacleSpeed
  Color light = Color::kBlack;  // of one lamp on each of its sides; black = none

  bool Moves() const { return !path.empty() && speed > 0.0; }
  bool Plain() const { return path.empty() && speed == 0.0 && light == Color::kBlack; }
  bool Lit() const { return light != Color::kBlack; }
  bool operator==(const ObstacleGene&) const = default;
};

// Half of a robot's speed; physics keeps robots out of boxes up to this speed (tests/sim/moving_obstacles).
inline constexpr double kMaxObstacleSpeed = 0.05;  // m/s
inline constexpr std::size_t kMaxObstaclePath = 16;

// All genes of a test case (the thesis' chromosome). Order matters: validity is judged gene by gene.
using Genome = std::vector<ObstacleGene>;

OrientedBox BoxOf(const ObstacleGene& gene);

// The one canonical encoding of genomes: search states, stored test cases, digests and hashes use it. A
// genome of fixed, dark obstacles has the bytes it had before there were others. Number of genes, then of
// each x, y, length, width, orientation. When an obstacle moves or has lights, the number's highest bit is
// set and each gene goes on with speed, light, number of the path's points, points.
void EncodeGenome(const Genome& genome, CanonicalEncoder& encoder);
// The opposite. After bytes that no genome has, decoder.ok() is false or genes are incomplete.
Genome DecodeGenome(CanonicalDecoder& decoder);

// FNV-1a over the genes; equal for equal genomes.
std::uint64_t GenomeHash(const Genome& genome);

}  // namespace gauntlet::sim
