#include "tests/integration/crowd_drill.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <memory>
#include <vector>

#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {

using nlohmann::json;

CrowdReport WatchACrowd(const std::string& dir, int workers, std::chrono::seconds duration) {
  SmallCampaign campaign;
  campaign.population = 1000;
  campaign.generations = 1000;
  const std::unique_ptr<Process> master =
      StartGauntlet(EvolveArguments(campaign, dir, workers - workers / 2));
  std::vector<std::unique_ptr<Process>> others;
  for (int i = 0; i < workers / 2; ++i) others.push_back(StartWorker(dir));
  // Each computes the golden hash first, which takes a second of CPU time and more.
  EXPECT_TRUE(Eventually(
      [&] {
        const json status = StatusOf(dir);
        return status.is_object() && status.value("workers", 0) == workers;
      },
      std::chrono::seconds(300)))
      << MasterLog(dir);

  Eventually([&] { return !master->Running(); }, duration);
  EXPECT_TRUE(master->Running()) << master->Err();
  const json status = StatusOf(dir);
  CrowdReport report;
  report.joined = status.value("workers", -1);
  report.lost = status.value("workers_lost", -1);
  report.leased_again = status.value("leased_again", -1);
  report.runs = status.value("runs_done", -1);
  std::ifstream("/proc/loadavg") >> report.load;
  master->Signal(SIGTERM);
  EXPECT_EQ(master->Wait().exit_code, 3);
  for (const auto& other : others) EXPECT_EQ(other->Wait().exit_code, 0) << other->Err();
  return report;
}

}  // namespace gauntlet::testing_support
