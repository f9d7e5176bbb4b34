// The place of a split in a run's picture: who left then, and a box of words where it hides the least.
#pragma once

#include <string>
#include <vector>

#include "analysis/figures/run_tracks.h"

namespace gauntlet::analysis {

class SplitCallout {
 public:
  // `split` has a point. `keep_free`: what the box should not hide beside the ways.
  SplitCallout(const RunFigure& figure, const sim::Annotation& split, const FigureFrame& frame,
               const std::vector<Track>& tracks, std::vector<Pixel> keep_free);

  // Below the robots, and what stands above them.
  void DrawPlace(SvgCanvas& canvas) const;
  void DrawRobotsAndLabel(SvgCanvas& canvas) const;

 private:
  Pixel place_;
  double radius_;  // pixels
  std::string label_;
  double width_;             // pixels, of the box
  Pixel corner_;             // of the box
  std::vector<Pixel> left_;  // where those who left were at that moment
};

}  // namespace gauntlet::analysis
