#include "tests/integration/question_drill.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <system_error>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

// Whether a campaign in `folder` has an entry of this name.
bool HasCampaignWith(const std::string& folder, const std::string& entry) {
  std::error_code none;
  const std::filesystem::directory_iterator campaigns(folder, none);
  return std::any_of(begin(campaigns), end(campaigns), [&](const auto& campaign) {
    return std::filesystem::exists(campaign.path() / entry, none);
  });
}

}  // namespace

std::vector<std::string> StateHashesIn(const std::string& folder) {
  std::vector<std::string> hashes;
  for (const auto& campaign : std::filesystem::directory_iterator(folder)) {
    if (campaign.is_directory()) hashes.push_back(StateHash(campaign.path()));
  }
  std::ranges::sort(hashes);
  return hashes;
}

ProcessResult AskThroughKills(const std::vector<std::string>& command, const std::string& folder,
                              int worker_kills) {
  // Runs that take a while, so that there is somebody to kill.
  const std::vector<std::string> slowly = {"GAUNTLET_WORKER=" + WorkerPath() + "-slow",
                                           "GAUNTLET_TEST_RUN_MILLISECONDS=5"};
  for (const char* sign : {"status.json", "campaign.db-wal"}) {
    const std::unique_ptr<Process> master = StartGauntlet(command, slowly);
    EXPECT_TRUE(Eventually([&] { return HasCampaignWith(folder, sign) || !master->Running(); }, kPatience));
    EXPECT_TRUE(master->Running()) << "there was nothing to kill";
    master->Signal(SIGKILL);
    master->Wait();
  }
  const std::unique_ptr<Process> master = StartGauntlet(command, slowly);
  EXPECT_TRUE(
      Eventually([&] { return HasCampaignWith(folder, "access.json") || !master->Running(); }, kPatience));
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  int hits = 0;
  while (hits < worker_kills && !Eventually([&] { return !master->Running(); },
                                            RandomTime(random, std::chrono::milliseconds(100)))) {
    hits += KillADescendant(*master, random) ? 1 : 0;
  }
  EXPECT_GT(hits, 0);
  return master->Wait();
}

}  // namespace gauntlet::testing_support
