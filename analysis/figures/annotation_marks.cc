#include "analysis/figures/annotation_marks.h"

#include <algorithm>

namespace gauntlet::analysis {

std::vector<const sim::Annotation*> MarkedBy(const RunFigure& figure, const sim::AnnotationStyle& style) {
  std::vector<const sim::Annotation*> marked;
  for (const sim::Annotation& annotation : figure.result.annotations) {
    if (annotation.kind != style.kind || annotation.points.empty()) continue;
    if (style.label.empty() || annotation.label == style.label) marked.push_back(&annotation);
  }
  return marked;
}

std::vector<const sim::Annotation*> MarkedAs(const RunFigure& figure, sim::Mark mark) {
  std::vector<const sim::Annotation*> marked;
  for (const sim::AnnotationStyle& style : figure.style.annotations) {
    if (style.mark != mark) continue;
    const auto some = MarkedBy(figure, style);
    marked.insert(marked.end(), some.begin(), some.end());
  }
  return marked;
}

const sim::Annotation* LatestMarkedAs(const RunFigure& figure, sim::Mark mark) {
  const auto marked = MarkedAs(figure, mark);
  const auto latest = std::max_element(marked.begin(), marked.end(),
                                       [](const auto* a, const auto* b) { return a->tick <= b->tick; });
  return latest == marked.end() ? nullptr : *latest;
}

}  // namespace gauntlet::analysis
