// How searches that learn went: fitness and failures over the runs that they spent.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/figures/line_figure.h"
#include "report/figures/campaign_facts.h"

namespace gauntlet {

// A generation, or one of some fifty equal parts of a search without generations.
struct CourseBlock {
  std::uint64_t runs = 0;      // of the search up to its end
  MeanAndRange fitness = {};   // of its completed runs
  double failure_share = 0.0;  // of its runs, 0 to 1
};

// Searches that differ in their seed only: repeats of one another.
struct SearchCourse {
  std::string name;                               // what tells it from the other courses
  std::vector<std::vector<CourseBlock>> repeats;  // [search][block]
};

// In the order of the searches; those without a run, and those that do not breed, are left out.
std::vector<SearchCourse> CoursesOf(const CampaignFacts& facts);

// Mean over the repeats, with a band from the lowest to the highest of them when there are several.
analysis::LineFigure FigureOf(const SearchCourse& course, const std::string& title);

}  // namespace gauntlet
