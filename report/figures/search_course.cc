#include "report/figures/search_course.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "report/tables/conditions.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kParts = 50;             // of a search without generations
constexpr std::size_t kMostGenerations = 200;  // beyond, parts are drawn too

CourseBlock BlockOf(const std::vector<const RunFacts*>& runs, std::size_t begin, std::size_t end) {
  CourseBlock block{.runs = end, .fitness = {}, .failure_share = 0.0};
  double failures = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    if (runs[i]->total_failure) failures += 1.0;
    if (runs[i]->completed) block.fitness.Add(runs[i]->fitness);
  }
  block.failure_share = failures / static_cast<double>(end - begin);
  return block;
}

std::vector<CourseBlock> BlocksOf(const std::vector<const RunFacts*>& runs) {
  std::vector<std::size_t> ends;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    if (runs[i]->generation != runs[i - 1]->generation) ends.push_back(i);
  }
  if (ends.empty() || ends.size() > kMostGenerations) {
    ends.clear();
    const std::size_t size = (runs.size() + kParts - 1) / kParts;
    for (std::size_t end = size; end < runs.size(); end += size) ends.push_back(end);
  }
  ends.push_back(runs.size());
  std::vector<CourseBlock> blocks;
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    blocks.push_back(BlockOf(runs, begin, end));
    begin = end;
  }
  return blocks;
}

// The mean over the repeats, with a band when there are several.
analysis::FigureLine LineOf(const SearchCourse& course, const std::string& name,
                            double (*value)(const CourseBlock&)) {
  analysis::FigureLine line{.name = name};
  const bool band = course.repeats.size() > 1;
  std::size_t blocks = 0;
  for (const auto& repeat : course.repeats) blocks = std::max(blocks, repeat.size());
  for (std::size_t i = 0; i < blocks; ++i) {
    MeanAndRange runs;
    MeanAndRange values;
    for (const auto& repeat : course.repeats) {
      if (i >= repeat.size()) continue;
      runs.Add(static_cast<double>(repeat[i].runs));
      if (const double one = value(repeat[i]); std::isfinite(one)) values.Add(one);
    }
    line.x.push_back(runs.mean());
    line.y.push_back(values.mean());
    if (!band) continue;
    line.low.push_back(values.lowest());
    line.high.push_back(values.highest());
  }
  return line;
}

}  // namespace

std::vector<SearchCourse> CoursesOf(const CampaignFacts& facts) {
  std::map<SearchId, std::vector<const RunFacts*>> runs;
  for (const RunFacts& run : facts.runs) runs[run.search].push_back(&run);
  std::vector<SearchCourse> courses;
  std::map<std::string, std::size_t> places;
  for (const auto& [search, some] : runs) {
    const SearchPlan& plan = facts.plans.at(search - 1);
    if (!RowOf(plan.experiment).Breeds()) continue;
    const std::string name = ConditionOf(plan.settings);
    const auto [place, is_new] = places.try_emplace(name, courses.size());
    if (is_new) courses.push_back({name, {}});
    courses[place->second].repeats.push_back(BlocksOf(some));
  }
  return courses;
}

analysis::LineFigure FigureOf(const SearchCourse& course, const std::string& title) {
  const std::size_t repeats = course.repeats.size();
  return {
      .title = title,
      .outcome = repeats > 1
                     ? fmt::format("mean of {} searches; bands: from the lowest to the highest", repeats)
                     : "one search",
      .x_name = "runs spent by a search",
      .panels = {
          {.axis_name = "fitness (lower = tougher)",
           .lines = {LineOf(course, "toughest", [](const CourseBlock& one) { return one.fitness.lowest(); }),
                     LineOf(course, "mean", [](const CourseBlock& one) { return one.fitness.mean(); })}},
          {.axis_name = "total failures, % of the runs",
           .lines = {LineOf(course, "failures",
                            [](const CourseBlock& one) { return 100.0 * one.failure_share; })},
           .least = 0.0,
           .most = 100.0}}};
}

}  // namespace gauntlet
