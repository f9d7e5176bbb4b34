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

// When the access file of a campaign in `folder` was last written; min(): there is none.
std::filesystem::file_time_type LastServed(const std::string& folder) {
  auto last = std::filesystem::file_time_type::min();
  std::error_code none;
  for (const auto& campaign : std::filesystem::directory_iterator(folder, none)) {
    const auto written = std::filesystem::last_write_time(campaign.path() / "access.json", none);
    if (!none) last = std::max(last, written);
  }
  return last;
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
  // Before it serves workers, whom it has started are no workers, and it cannot do without them.
  const auto served_before = LastServed(folder);
  const std::unique_ptr<Process> master = StartGauntlet(command, slowly);
  EXPECT_TRUE(
      Eventually([&] { return LastServed(folder) != served_before || !master->Running(); }, kPatience));
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
