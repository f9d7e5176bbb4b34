// One obstacle of a test case as the genetic algorithm sees it (thesis 3.2.1: a "single descriptor").
#pragma once

#include <vector>

#include "sim/geometry/oriented_box.h"

namespace gauntlet::sim {

struct ObstacleGene {
  double x = 0.0;                // m, centre
  double y = 0.0;                // m, centre
  double length = 0.0;           // m
  double width = 0.0;            // m
  double orientation_deg = 0.0;  // degrees counter-clockwise, [0, 360); degrees, because the thesis' genes
                                 // are whole degrees and a case file must give back the very same number

  bool operator==(const ObstacleGene&) const = default;
};

// All genes of a test case (the thesis' chromosome). Order matters: validity is judged gene by gene.
using Genome = std::vector<ObstacleGene>;

OrientedBox BoxOf(const ObstacleGene& gene);

}  // namespace gauntlet::sim
