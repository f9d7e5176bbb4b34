// The served pages of a campaign with many runs and many workers do bounded work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include <nlohmann/json.hpp>

#include "master/campaign/campaign_status.h"
#include "master/directory/campaign_lock.h"
#include "tests/integration/browser.h"
#include "tests/integration/campaign_driver.h"
#include "tests/integration/ui_driver.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kRuns = 10'000;
constexpr std::size_t kWorkers = 500;
constexpr std::size_t kMostBytesOfAWorker = 400;  // in an answer to a page that asks every second
constexpr std::size_t kMostBytesBeside = 20'000;

// What a master with so many workers says.
std::string StatusOfACrowd() {
  MasterView view;
  view.campaign_id = "c";
  view.host = "node7";
  view.now_unix_ms = std::chrono::duration_cast<std::chrono::milliseconds>(
                         std::chrono::system_clock::now().time_since_epoch())
                         .count();
  CampaignProgress progress;
  progress.runs_done = kRuns;
  progress.runs_planned = 2 * kRuns;
  BackendView backend;
  for (std::size_t i = 0; i < kWorkers; ++i) {
    WorkerView& worker = backend.workers.emplace_back();
    worker.label = "1cfc97e775e2ec" + std::to_string(i) + "@node" + std::to_string(i / 16);
    worker.record.finished = 20;
    worker.leases = {{.run = 2 * i + 1, .fence = 1, .seconds = 4.2}, {.run = 2 * i + 2, .waits = true}};
  }
  return StatusJson(view, progress, backend);
}

class BusyCampaignTest : public testing::Test {
 protected:
  // A campaign of ten thousand runs that did nothing, whose living master this process pretends to be.
  void SetUp() override {
    const auto search =
        StartGauntlet({"random", "flocking", "--cases", std::to_string(kRuns), "--dir", dir_, "--quiet"},
                      {"GAUNTLET_WORKER=" GAUNTLET_BINARY_DIR "/gauntlet-worker-noop"});
    ASSERT_EQ(search->Wait().exit_code, 0) << search->Err();
    auto lock = CampaignLock::Acquire(dir_ + "/lock", dir_);
    ASSERT_TRUE(lock) << lock.error().message;
    lock_ = *std::move(lock);
    std::ofstream(dir_ + "/status.json") << StatusOfACrowd();
  }

  TemporaryDirectory scratch_;
  std::string dir_ = scratch_ / "busy";
  std::unique_ptr<CampaignLock> lock_;
};

TEST_F(BusyCampaignTest, AnAnswerToAPageThatAsksEverySecondIsSmall) {
  const Ui ui(dir_);
  const std::string answer = ui.Get(ui.root() + "status");
  constexpr std::size_t kListed = 200;
  EXPECT_THAT(answer, HasSubstr("@node12"));
  EXPECT_THAT(answer, HasSubstr(R"("workers_not_listed":{"running":300,)"));
  EXPECT_LT(answer.size(), kListed * kMostBytesOfAWorker + kMostBytesBeside);
}

TEST_F(BusyCampaignTest, PagesShowAFewRowsAndAnswerClicks) {
  if (BrowserPath().empty()) GTEST_SKIP() << "there is no Chromium here (package chromium-headless-shell)";
  const Ui ui(dir_);
  Browser browser;
  browser.Open(ui.address() + "#live");
  const std::string workers = "document.querySelectorAll('#live .workers tbody tr').length";
  ASSERT_TRUE(browser.Becomes(workers + " === 50")) << browser.Evaluate("document.body.innerText");
  browser.Evaluate("[...document.querySelectorAll('#live button')].find(b => !b.hidden).click()");
  EXPECT_EQ(browser.Evaluate(workers), 100);
  browser.Evaluate("document.querySelector('nav a[href=\"#failures\"]').click()");
  ASSERT_TRUE(browser.Becomes("document.getElementById('failures').classList.contains('shown')"));
  const std::string rows = "document.querySelectorAll('.all-cases tbody tr').length";
  EXPECT_EQ(browser.Evaluate(rows), 100);
  const std::string first = "document.querySelector('.all-cases tbody td').textContent";
  browser.Evaluate("document.querySelector('.all-cases th button').click()");
  EXPECT_EQ(browser.Evaluate(first), "1");
  browser.Evaluate("document.querySelector('.all-cases th button').click()");
  EXPECT_EQ(browser.Evaluate(first), std::to_string(kRuns));
  EXPECT_EQ(browser.Evaluate(rows), 100);
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

}  // namespace
}  // namespace gauntlet::testing_support
