// What 'gauntlet ui' answers: the pages of campaigns, any of their runs simulated again, and what they do
// now.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/http/http_server.h"
#include "master/session/campaign_service.h"

namespace gauntlet {

class ServedCampaigns {
 public:
  // `sets`: as `compare` names them. `campaigns` must outlive this. Errors: those of GatherReport.
  static Result<std::unique_ptr<ServedCampaigns>> Open(const std::vector<std::string>& sets,
                                                       CampaignService& campaigns);
  ServedCampaigns(const ServedCampaigns&) = delete;
  ServedCampaigns& operator=(const ServedCampaigns&) = delete;
  ~ServedCampaigns();

  // Thread-safe. C is the number of a campaign, from 0.
  //   ""              the pages, of what is stored now (HTML)
  //   "status"        {"campaigns": [{"directory", "error", "status", "events", "toughest"}]}: what each does
  //   "progress/C"    how its searches went so far (SVG); "progress/C/K": the K-th kind of search, from 0
  //   "cases/C"       [[...]]: a row for each test case, with the columns that the pages name
  //   "run/C/ID"      {"page", "replay"}: a run, simulated again
  // Anything else: 404. What cannot be read, because it was deleted, for instance: 410 with the reason.
  HttpAnswer Answer(const std::string& path);

 private:
  struct Followed;
  ServedCampaigns(std::vector<std::string> sets, CampaignService& campaigns);

  HttpAnswer AnswerPages();
  HttpAnswer AnswerStatus();
  HttpAnswer AnswerProgress(Followed& followed, std::size_t course);
  HttpAnswer AnswerCases(Followed& followed);
  HttpAnswer AnswerRun(Followed& followed, std::size_t campaign, RunId run);

  const std::vector<std::string> sets_;
  CampaignService& campaigns_;
  // Those that the sets name now, a study's later ones too; those that were there before when they are gone.
  std::vector<std::shared_ptr<Followed>> FollowedNow();

  std::mutex mutex_;  // guards the rest
  std::vector<std::shared_ptr<Followed>> followed_;
};

}  // namespace gauntlet
