// What a fit leaves open of a result: a figure of runs, under one accepted setting after the other.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "analysis/tables/table.h"
#include "base/result.h"
#include "study/fits/fit_result.h"

namespace gauntlet {

// Settings that were drawn by their weights, as "key=value"; the first ones stay the same when more are
// drawn.
std::vector<std::vector<std::string>> DrawSettings(const FitResult& fit, std::size_t count);

// By name; of a study its own, of a campaign these: the mean of every metric over all of its runs, and of the
// fitness of its final population.
using Figures = std::map<std::string, double>;
Result<Figures> FiguresOfCampaign(const std::string& dir);

// What came of the draws by now, in a CSV file of lines "draw,name,value", which grows draw by draw.
class PredictionFile {
 public:
  // There may be none yet. Error: it cannot be read, or is no such file.
  static Result<PredictionFile> Open(const std::string& path);

  std::size_t size() const { return draws_.size(); }
  // Of the next draw: its settings and its figures. They are on disk afterwards.
  Status Add(const std::vector<std::string>& settings, const Figures& figures);
  // The range of each figure over the first draws.
  Table Ranges(std::size_t count) const;

 private:
  struct Drawn {
    std::vector<std::string> settings;
    Figures figures;
  };
  std::string Text() const;

  std::string path_;
  std::vector<Drawn> draws_;
};

}  // namespace gauntlet
