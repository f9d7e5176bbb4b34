// The campaigns of a study on disk: one of all searches, and when these have finished one of everything that
// is simulated again. All searches of a campaign share one pool of workers.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/search_plans.h"
#include "study/sets/run_set.h"
#include "study/study.h"

namespace gauntlet {

enum class StudyStage { kSearches, kEvaluations };
StudyStage StageOf(const StudyPart& part);

// The files of a study's directory.
std::string StudyFile(const std::string& dir);                               // study.json: the study's texts
std::string CampaignOf(const std::string& dir, StudyStage stage);            // a campaign's directory
std::string UnfinishedCampaignOf(const std::string& dir, StudyStage stage);  // while it is being made
// The directories of those of its campaigns that there are.
std::vector<std::string> CampaignsIn(const std::string& dir);

// Whether `dir` holds a study.
bool IsStudy(const std::string& dir);
// Makes the directory when it is not there. What is computed from the runs may have changed since it was
// begun, its parts may not. Error: the directory holds something else, another study, or one of other parts.
Status BeginStudy(const std::string& dir, const Study& study);
// The study that a directory holds. Errors: kNotFound, kCorrupt; others may write there.
Result<Study> OpenStudy(const std::string& dir);

// The searches of a stage, part by part; of the second with the cases that have come out of the first, which
// has finished.
Result<std::vector<SearchPlan>> PlanStage(const Study& study, const std::string& dir, StudyStage stage);
// Searches as long as those of the part, for a forecast: of an evaluation, whose cases are not there yet,
// with random ones in their place (as many as one population holds, where its subset is "all").
std::vector<SearchPlan> ForecastPlans(const Study& study, const StudyPart& part);

// Whether the stage's campaign exists and has come to its end. Error: it is of another study (kInvalidInput),
// or cannot be read.
struct StageState {
  bool exists = false;
  bool finished = false;
};
Result<StageState> LookAtStage(const Study& study, const std::string& dir, StudyStage stage);

// What a part has cost.
struct PartCost {
  std::string part;
  std::uint64_t searches = 0;
  std::uint64_t runs = 0;            // simulations
  std::uint64_t cases = 0;           // members of the final populations, or all cases
  std::uint64_t distinct_cases = 0;  // that were ever simulated
  double cpu_seconds = 0.0;          // of its simulations, where that was asked for

  PartCost& operator+=(const PartCost& other);  // keeps its name
};

struct ClockTime {
  double seconds = 0.0;
  bool at_least = false;  // a master was killed: how long it had lived is not known
};

// Reads the runs of a study whose stages have finished.
class StudyRuns {
 public:
  static Result<StudyRuns> Open(const Study& study, const std::string& dir);

  // The set that an analysis names, "PART:SUBSET,...".
  Result<RunSet> Set(const std::string& text, const std::string& metric);
  // Of each run of the set the metrics PREFIX1, PREFIX2, ...; as many in every run.
  Result<std::vector<std::vector<double>>> Windows(const std::string& text, const std::string& prefix);
  // All runs of a part, by its searches.
  Result<std::vector<std::vector<SelectedRun>>> All(const std::string& part, const std::string& metric);
  // The names of the scenario's failure types.
  std::vector<std::string> FailureTypes(const std::string& set) const;
  // The part that a part's cases come from: itself unless it evaluates another's.
  std::string SourceOf(const std::string& part) const;
  Result<PartCost> CostOf(const std::string& part);
  // CPU time of the part's simulations, s.
  Result<double> CpuSecondsOf(const std::string& part);
  // From start to end of all masters.
  Result<ClockTime> TimeOf(StudyStage stage);

 private:
  struct Campaign {
    OpenedSubset opened;
    RunOrigin origin;
  };
  explicit StudyRuns(const Study& study) : study_(&study) {}
  const StudyPart& Part(const std::string& name) const;
  // Those of a part, with their ids in the campaign of its stage.
  Status ForEachSearch(const std::string& part, const std::function<Status(Campaign&, SearchId)>& visit);
  // The results of all runs of a part.
  Status ForEachResult(const std::string& part, const std::function<void(const sim::RunResult&)>& visit);

  const Study* study_;
  std::vector<Campaign> campaigns_;  // by stage
};

}  // namespace gauntlet
