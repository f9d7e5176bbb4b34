#include "report/figures/search_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kParts = 50;             // of a search without generations
constexpr std::size_t kMostGenerations = 200;  // beyond, parts are drawn too

CourseBlock BlockOf(const std::vector<const RunFacts*>& runs, std::size_t begin, std::size_t end) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  CourseBlock block{.runs = end, .best = kNone, .mean = 0.0, .failure_share = 0.0};
  double completed = 0.0;
  double failures = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    if (runs[i]->total_failure) failures += 1.0;
    if (!runs[i]->completed) continue;
    completed += 1.0;
    block.best = std::fmin(block.best, runs[i]->fitness);
    block.mean += (runs[i]->fitness - block.mean) / completed;
  }
  if (completed == 0.0) block.mean = kNone;
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

// The same for experiments that differ in their seed only.
std::string WithoutSeed(Experiment experiment) {
  experiment.seed = 0;
  return WriteExperiment(experiment, {}, BuiltInCatalogue());
}

// "search.population=20, seed 3" without the seed.
std::string NameOfCourse(const std::string& settings) {
  std::string name;
  std::size_t begin = 0;
  while (begin < settings.size()) {
    const std::size_t end = std::min(settings.find(", ", begin), settings.size());
    const std::string part = settings.substr(begin, end - begin);
    if (!part.starts_with("seed ")) name += (name.empty() ? "" : ", ") + part;
    begin = end + 2;
  }
  return name;
}

double ValueOf(const CourseBlock& block, double CourseBlock::*value, double scale) {
  return scale * (block.*value);
}

analysis::FigureLine LineOf(const SearchCourse& course, const std::string& name, double CourseBlock::*value,
                            double scale) {
  analysis::FigureLine line{.name = name};
  const bool band = course.repeats.size() > 1;
  std::size_t blocks = 0;
  for (const auto& repeat : course.repeats) blocks = std::max(blocks, repeat.size());
  for (std::size_t i = 0; i < blocks; ++i) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double runs = 0.0;
    double repeats = 0.0;
    double sum = 0.0;
    double values = 0.0;
    double low = kNone;
    double high = kNone;
    for (const auto& repeat : course.repeats) {
      if (i >= repeat.size()) continue;
      repeats += 1.0;
      runs += static_cast<double>(repeat[i].runs);
      const double one = ValueOf(repeat[i], value, scale);
      if (!std::isfinite(one)) continue;
      values += 1.0;
      sum += one;
      low = std::fmin(low, one);
      high = std::fmax(high, one);
    }
    line.x.push_back(runs / repeats);
    line.y.push_back(values > 0.0 ? sum / values : kNone);
    if (!band) continue;
    line.low.push_back(low);
    line.high.push_back(high);
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
    const auto [place, is_new] = places.try_emplace(WithoutSeed(plan.experiment), courses.size());
    if (is_new) courses.push_back({NameOfCourse(plan.settings), {}});
    courses[place->second].repeats.push_back(BlocksOf(some));
  }
  return courses;
}

analysis::LineFigure FigureOf(const SearchCourse& course, const std::string& title) {
  const std::size_t repeats = course.repeats.size();
  return {.title = title,
          .outcome = repeats > 1
                         ? fmt::format("mean of {} searches; bands: from the lowest to the highest", repeats)
                         : "one search",
          .x_name = "runs spent by a search",
          .panels = {{.axis_name = "fitness (lower = tougher)",
                      .lines = {LineOf(course, "toughest", &CourseBlock::best, 1.0),
                                LineOf(course, "mean", &CourseBlock::mean, 1.0)}},
                     {.axis_name = "total failures, % of the runs",
                      .lines = {LineOf(course, "failures", &CourseBlock::failure_share, 100.0)},
                      .least = 0.0,
                      .most = 100.0}}};
}

}  // namespace gauntlet
