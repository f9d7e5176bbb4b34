#include "cli/adopt/score_candidates.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string_view>

#include "base/nearest_name.h"
#include "base/split.h"
#include "base/system/atomic_file.h"
#include "controllers/command/metric_source.h"
#include "controllers/command/trajectory_file.h"
#include "controllers/command/trajectory_measures.h"

namespace gauntlet {
namespace {

namespace command = controllers::command;

constexpr std::string_view kMeasure = "trajectory:";
constexpr std::size_t kMostLines = 2000;  // of the last ones printed
constexpr std::size_t kMostPatterns = 100;
constexpr std::size_t kMostLineBytes = 300;
constexpr std::size_t kMostCsvBytes = std::size_t{16} << 20;
constexpr const char* kNumber = "[-+.0-9eE]+";

std::string Escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (std::string_view(R"(\^$.|?*+()[]{})").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

// For each number of the line a pattern whose group it is.
std::vector<std::string> PatternsOf(const std::string& line) {
  // A number stands by itself: "fb12" and "3.2.1" hold none.
  static const std::regex number(
      R"((^|[^A-Za-z0-9_.\-+])([-+]?[0-9]+\.?[0-9]*(?:[eE][-+]?[0-9]+)?)(?![A-Za-z0-9_.]))");
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (auto one = std::sregex_iterator(line.begin(), line.end(), number); one != std::sregex_iterator();
       ++one)
    places.emplace_back(one->position(2), one->length(2));
  std::vector<std::string> patterns;
  for (std::size_t chosen = places.size(); chosen-- > 0;) {
    std::string pattern = "^";
    std::size_t end = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      pattern += Escaped(std::string_view(line).substr(end, places[i].first - end));
      pattern += i == chosen ? "(" + std::string(kNumber) + ")" : std::string(kNumber);
      end = places[i].first + places[i].second;
    }
    patterns.push_back("log:" + pattern + Escaped(std::string_view(line).substr(end)) + "$");
  }
  return patterns;
}

// Those of lines that were printed once go to `once`: a score, more likely than what every tick says.
void AddLogSources(const std::string& text, std::vector<std::string>& once, std::vector<std::string>& often) {
  std::vector<std::string> lines = Split(text, '\n');
  std::ranges::reverse(lines);
  if (lines.size() > kMostLines) lines.resize(kMostLines);
  std::vector<std::string> patterns;
  std::map<std::string, int> counts;
  for (const std::string& line : lines) {
    if (line.empty() || line.size() > kMostLineBytes || patterns.size() > kMostPatterns) continue;
    for (std::string& pattern : PatternsOf(line))
      if (++counts[pattern] == 1) patterns.push_back(std::move(pattern));
  }
  for (std::string& pattern : patterns) (counts[pattern] == 1 ? once : often).push_back(std::move(pattern));
}

void AddCsvSources(const std::string& folder, const std::string& file, std::vector<std::string>& sources) {
  const Result<std::string> text = ReadSmallFile(folder + "/" + file, kMostCsvBytes);
  if (!text || text->find('\0') != std::string::npos) return;
  // More columns than a file has are no sources, which reading them shows.
  constexpr int kMostColumns = 40;
  std::vector<std::string> columns;
  for (int column = kMostColumns; column >= 1; --column) columns.push_back(std::to_string(column));
  for (const std::string& column : columns) {
    std::string source = "csv:" + file + ":" + column;
    if (command::ReadSource(source, "", "", folder)) sources.push_back(std::move(source));
  }
}

Result<double> MeasureOf(const TrialRun& run, const std::string& name) {
  if (FindByName(command::TrajectoryMeasureNames(), name) == nullptr)
    return InvalidInput(UnknownName("measure", name, command::TrajectoryMeasureNames()));
  sim::RunResult result;
  TRY(command::ReadTrajectory(run.folder + "/" + kTrajectoryFile, kTrajectoryFile, /*record=*/true, result));
  return command::TrajectoryMeasures({}, sim::RunSpec(), result.trajectory).at(name);
}

}  // namespace

Result<double> ScoreIn(const TrialRun& run, const std::string& from) {
  if (from.starts_with(kMeasure)) return MeasureOf(run, from.substr(kMeasure.size()));
  TRY(command::CheckSource(from));
  return command::ReadSource(from, run.out, run.err, run.folder);
}

Result<ScoreCandidate> ScoreNamed(const std::string& from, const TrialRun& first, const TrialRun& other_seed,
                                  const TrialRun& with_obstacle) {
  ScoreCandidate candidate{.from = from};
  TRY(candidate.first, ScoreIn(first, from));
  TRY(candidate.other_seed, ScoreIn(other_seed, from));
  TRY(candidate.with_obstacle, ScoreIn(with_obstacle, from));
  return candidate;
}

std::vector<ScoreCandidate> FindScores(const TrialRun& first, const TrialRun& other_seed,
                                       const TrialRun& with_obstacle, const std::vector<std::string>& written,
                                       std::size_t most) {
  std::vector<std::string> sources;
  std::vector<std::string> often;
  AddLogSources(first.out, sources, often);
  AddLogSources(first.err, sources, often);
  for (const std::string& file : written) AddCsvSources(first.folder, file, sources);
  sources.insert(sources.end(), often.begin(), often.end());
  std::vector<ScoreCandidate> found;
  for (const std::string& source : sources) {
    const Result<ScoreCandidate> candidate = ScoreNamed(source, first, other_seed, with_obstacle);
    if (candidate) found.push_back(*candidate);
  }
  std::stable_partition(found.begin(), found.end(), [](const auto& one) { return one.Varies(); });
  if (found.size() > most) found.resize(most);
  return found;
}

}  // namespace gauntlet
