// Campaigns that only note what they are asked.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "master/session/campaign_service.h"

namespace gauntlet::testing_support {

class FakeCampaigns : public CampaignService {
 public:
  // What is answered; an error to all that can fail for another reason than a wrong directory.
  SessionReport report;
  std::vector<StoredRun> stored;
  CampaignReplay replay;
  std::string status;
  std::string change = "search.generations from 50 to 80";  // of what is extended
  int lives = 0;                                            // how often a master is found alive
  std::optional<Error> error;
  // Called while a session runs.
  std::function<void(const SessionOptions&)> during;

  // What was asked.
  int starts = 0;
  int resumes = 0;
  std::vector<std::string> extended;
  std::string directory;             // of the newest session
  std::vector<SearchPlan> searches;  // the searches of the newest campaign that was started
  Experiment experiment;             // of the first of them
  std::vector<sim::TestCase> cases;  // and its cases
  int workers = 0;
  std::vector<SearchPlan> prepared;
  std::string slurm;
  std::string stopped;
  RunId replayed_run = 0;

  Result<SessionReport> Start(const std::string& dir, const std::vector<SearchPlan>& wanted,
                              const SessionOptions& options) override {
    ++starts;
    slurm = options.slurm;
    searches = wanted;
    experiment = wanted.front().experiment;
    cases = wanted.front().cases;
    return Serve(dir, options);
  }
  Status Prepare(const std::string& dir, const std::vector<SearchPlan>& wanted,
                 const std::string& text) override {
    prepared = wanted;
    slurm = text;
    std::filesystem::create_directories(dir);
    std::ofstream(dir + "/slurm.toml") << text;
    return Ok{};
  }
  Result<std::string> Extend(const std::string& /*dir*/, const std::vector<std::string>& sets,
                             const std::function<bool()>& /*give_up*/) override {
    extended = sets;
    return Answer(change);
  }
  Result<SessionReport> Resume(const std::string& dir, const SessionOptions& options) override {
    ++resumes;
    return Serve(dir, options);
  }
  Result<CampaignSummary> Read(const std::string& /*dir*/) override { return Answer(report.summary); }
  Status ForEachRun(const std::string& /*dir*/, const RunVisitor& visit) override {
    for (const StoredRun& run : stored) {
      TRY(visit(run));
    }
    return Ok{};
  }
  Result<CampaignReplay> Replay(const std::string& /*dir*/, RunId run,
                                const std::string& /*scratch*/) override {
    replayed_run = run;
    return Answer(replay);
  }
  Result<std::string> ReadStatus(const std::string& /*dir*/) override { return Answer(status); }
  Result<bool> MasterLives(const std::string& /*dir*/) override { return lives-- > 0; }
  Status RequestStop(const std::string& dir) override {
    stopped = dir;
    return Ok{};
  }

 private:
  template <typename Value>
  Result<Value> Answer(const Value& value) const {
    return error ? Result<Value>(*error) : Result<Value>(value);
  }
  Result<SessionReport> Serve(const std::string& dir, const SessionOptions& options) {
    directory = dir;
    workers = options.workers;
    if (during) during(options);
    return Answer(report);
  }
};

}  // namespace gauntlet::testing_support
