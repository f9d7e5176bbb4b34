// Which annotations of a run are drawn how.
#pragma once

#include <vector>

#include "analysis/figures/run_figure.h"

namespace gauntlet::analysis {

// Those with points that the style declares as `mark`, in the result's order.
std::vector<const sim::Annotation*> MarkedAs(const RunFigure& figure, sim::Mark mark);
// Those of one row of the style.
std::vector<const sim::Annotation*> MarkedBy(const RunFigure& figure, const sim::AnnotationStyle& style);
// Of these the one with the latest tick; nullptr when there is none.
const sim::Annotation* LatestMarkedAs(const RunFigure& figure, sim::Mark mark);

}  // namespace gauntlet::analysis
