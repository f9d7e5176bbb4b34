// Parts of what campaigns hold, as commands name them: DIR:final, DIR:random:100, DIR:search:2:all.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "controllers/behaviour.h"
#include "master/directory/campaign_ownership.h"
#include "master/directory/search_plans.h"

namespace gauntlet {

// Which runs of a campaign.
struct Subset {
  enum class Kind {
    kFinal,  // the newest evaluation of each member of the population (of `random` and `evaluate`: all cases)
    kAll,    // every run
    kRandom,  // `count` of all, drawn without replacement; the same ones every time
    kWorst,   // the `count` of lowest fitness, of equal ones the earlier
  };
  Kind kind = Kind::kFinal;
  std::uint64_t count = 0;
  std::uint32_t search = 0;  // its number in a sweep; 0 = all searches
};

// "final", "all", "random:100", "worst:100"; before it "search:2" for one of a sweep; "" stands for final.
// `place` is for messages.
Result<Subset> ParseSubset(const std::string& text, const std::string& place);

// One of the names that a set is given by, several with commas in between.
struct SetPart {
  std::string path;  // of a campaign or a CSV file; the longest beginning that exists, so it may hold colons
  std::string rest;  // behind the colon
};
// kNotFound when there is nothing of such a name, kInvalidInput when one is named twice.
Result<std::vector<SetPart>> SplitSet(const std::string& text);

struct OpenedSubset {
  CampaignView campaign;
  std::vector<SearchPlan> plans;
  Subset subset;
  std::string note;  // that the campaign is being written; "" = it is not
};
// Of a campaign's directory. Errors: those of ParseSubset, ViewCampaign and CheckStored.
Result<OpenedSubset> OpenSubset(const SetPart& part);

// A search that a subset is about.
struct SubsetSearch {
  const SearchPlan& plan;
  std::string place;  // the campaign's, with the search's number where it has several
  bool finished = false;
};
// Error: runs of one of the searches have settings of their own (SearchRow::varies_settings), so that they
// cannot be taken together.
// Of a stream of cases the store says whether any line had settings of its own; without it, one may have.
Status CheckOneSetting(const std::vector<SearchPlan>& plans, const std::string& place,
                       ResultStore* store = nullptr);

// Visits them in the order of their numbers, until one of the visits fails. Error: there is no such search.
Status ForEachSearch(const std::vector<SearchPlan>& plans, ResultStore& store, const std::string& place,
                     const Subset& subset, const std::function<Status(const SubsetSearch&)>& visit);

// A metric's value; none when there was nothing to measure. `info`: nullptr = nobody knows the metric.
std::optional<double> MeasuredValue(const controllers::MetricInfo* info, double value);

// Whether `metric` is "fitness", "total_failure" (1 or 0), "failure_type" (none: no total failure, or of no
// type) or a metric of the experiment's scenario. Error: names the nearest.
Status CheckMetric(const Experiment& experiment, const std::string& metric);

struct SelectedRun {
  RunId run = 0;
  IndividualId individual = 0;
  std::uint32_t evaluation = 0;
  std::uint32_t generation = 0;
  std::optional<double> value;  // none: without a result, or nothing to measure
};
// The subset's runs of a search in logical order. Error: no such metric (CheckMetric), or fewer runs than
// asked for.
Result<std::vector<SelectedRun>> SelectRuns(const SubsetSearch& search, ResultStore& store,
                                            const Subset& subset, const std::string& metric);

}  // namespace gauntlet
