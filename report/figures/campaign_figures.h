// The figures of a campaign by name, each as a picture and as its data: what `gauntlet figure` writes and
// reports show.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "report/figures/campaign_facts.h"
#include "report/figures/run_map.h"
#include "report/figures/search_course.h"
#include "report/figures/shown_run.h"

namespace gauntlet {

struct NamedFigure {
  std::string name;
  std::string title;
  std::string reading;  // what it shows and how it is read
  std::function<std::string()> svg;
  std::function<std::string()> csv;  // its data, with a line of column names
};

// "progress" (with several kinds of searches "progress-1", "progress-2", ...), and the maps by their names.
std::vector<NamedFigure> FiguresOf(const std::vector<SearchCourse>& courses, const std::vector<RunMap>& maps);
// "run-981" (or "run-2:981"), "motion-981", and "states-981" where robots say what they do. Without a picture
// of a run that does not read back: none. `shown` must outlive them.
std::vector<NamedFigure> FiguresOf(const ShownRun& shown);

}  // namespace gauntlet
