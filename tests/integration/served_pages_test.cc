// gauntlet ui on real campaigns, asked by a real browser and by whoever has no business there.
// Covers: cli/commands/ui_command.cc, report/ui/campaign_feed.cc, report/ui/served_campaigns.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/integration/browser.h"
#include "tests/integration/campaign_database.h"
#include "tests/integration/campaign_driver.h"
#include "tests/integration/replayed_poses.h"
#include "tests/integration/shown_campaign.h"
#include "tests/integration/ui_driver.h"
#include "tests/support/local_socket.h"

namespace gauntlet::testing_support {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

TEST(ServedPagesTest, OnlyWhoKnowsTheAddressAndIsHereGetsIn) {
  const Ui ui(Campaign());
  EXPECT_THAT(ui.Get(ui.root() + "status"), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("\"finished\"")));
  EXPECT_THAT(ui.Get("/status"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(ui.Get("/"), AllOf(StartsWith("HTTP/1.1 403"), Not(HasSubstr(Campaign()))));
  EXPECT_THAT(ui.Get(ui.root() + "status", "Origin: http://evil.example\r\n"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(ui.Get(ui.root() + "../../../../etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(ui.Get(ui.root() + "%2e%2e/etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Converse(ui.port(), "GET " + ui.root() +
                                      "status HTTP/1.1\r\nHost: evil.example\r\n"
                                      "Connection: close\r\n\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(Converse(ui.port(), fmt::format("HEAD {}status HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n",
                                              ui.root(), ui.port())),
              AllOf(StartsWith("HTTP/1.1 200"), EndsWith("\r\n\r\n")));
  for (const std::string path :
       {"run/0/61", "run/1/1", "run/0/x", "run/0", "progress/7", "progress/0/9", "what"})
    EXPECT_THAT(ui.Get(ui.root() + path), StartsWith("HTTP/1.1 404")) << path;
}

TEST(ServedPagesTest, ACampaignOfANewerFormatIsRefusedByItsNumber) {
  const std::string dir = Scratch() / "newer";
  fs::copy(Campaign(), dir, fs::copy_options::recursive);
  AlterDatabase(dir, "PRAGMA user_version = 999");
  const ProcessResult ui = Gauntlet({"ui", dir});
  EXPECT_EQ(ui.exit_code, 2);
  EXPECT_THAT(ui.out, IsEmpty());
  EXPECT_EQ(ui.err, "gauntlet: " + (Scratch() / "newer/campaign.db") +
                        " has format 999, made by a newer gauntlet; this one reads format 3: use the newer "
                        "version (nothing was changed)\n");
}

TEST(ServedPagesTest, BadInputIsNamedAndSignalsEndIt) {
  Ui ui(Campaign());
  const ProcessResult taken = Gauntlet({"ui", Campaign(), "--port", std::to_string(ui.port())});
  EXPECT_EQ(taken.exit_code, 2);
  EXPECT_THAT(taken.err, HasSubstr(std::to_string(ui.port())));
  EXPECT_THAT(taken.out, IsEmpty());
  const ProcessResult wrong = Gauntlet({"ui", Campaign(), "--port", "high"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.err, "gauntlet: --port high: must be a port from 1 to 65535, or 0 for any free one\n");
  EXPECT_EQ(Gauntlet({"ui", Scratch() / "nothing"}).exit_code, 2);
  ui.process().Signal(SIGINT);
  EXPECT_EQ(ui.process().Wait().exit_code, 0);
  Ui other(Campaign());
  other.process().Signal(SIGTERM);
  EXPECT_EQ(other.process().Wait().exit_code, 0);
}

class ServedPagesInBrowserTest : public testing::Test {
 protected:
  void SetUp() override {
    if (BrowserPath().empty()) GTEST_SKIP() << "there is no Chromium here (package chromium-headless-shell)";
    browser_ = std::make_unique<Browser>();
  }
  std::string Live() { return browser_->Evaluate("document.getElementById('live').innerText"); }
  bool LiveSays(const std::string& text) {
    return Eventually([&] { return Live().find(text) != std::string::npos; }, kPatience);
  }
  bool NewsSay(const std::string& text) {
    return browser_->Becomes("(document.getElementById('news')?.innerText ?? '').includes('" + text + "')");
  }
  std::unique_ptr<Browser> browser_;
};

TEST_F(ServedPagesInBrowserTest, EveryRunOfTheStoreIsReplayedToItsStoredEnd) {
  const Ui ui(Campaign());
  browser_->Open(ui.address() + "#failures");
  // One that the pages do not hold.
  const std::string run = browser_->Evaluate(
      "[...document.querySelectorAll('.all-cases tbody a')].map(link => link.hash.slice(1))"
      ".find(id => !document.getElementById(id)).replace('run-0-', '')");
  browser_->Evaluate("document.querySelector(`a[href='#run-0-" + run + "']`).click()");
  ASSERT_TRUE(browser_->Becomes("document.querySelectorAll('.page.shown .robot').length > 0"));
  ASSERT_TRUE(PlayToTheEnd(*browser_));
  const Poses end = ShownPoses(*browser_);
  const Poses expected = LastPoses(Campaign(), run);
  ASSERT_EQ(end.size(), expected.size());
  for (std::size_t robot = 0; robot < end.size(); ++robot) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(end[robot][i], expected[robot][i], 1e-9) << robot;
  }
  EXPECT_THAT(browser_->complaints(), IsEmpty());
  for (const std::string& request : browser_->requests()) EXPECT_THAT(request, StartsWith(ui.address()));
}

TEST_F(ServedPagesInBrowserTest, ARunThatIsNotThereIsNamedInItsPlace) {
  const Ui ui(Campaign());
  browser_->Open(ui.address() + "#run-0-999");
  EXPECT_TRUE(browser_->Becomes("document.querySelector('.page.shown').innerText.includes('no run 999')"));
}

TEST_F(ServedPagesInBrowserTest, TheLivePageFollowsASearchItsKilledMasterAndItsEnd) {
  const std::string dir = Scratch() / "followed";
  auto master = StartGauntlet({"evolve", "flocking", "--generations", "400", "--dir", dir, "--quiet"});
  ASSERT_TRUE(Eventually([&] { return Gauntlet({"status", dir}).exit_code == 0; }, kPatience));
  const Ui ui(dir);
  browser_->Open(ui.address() + "#live");
  ASSERT_TRUE(LiveSays("The campaign is running"));
  EXPECT_TRUE(LiveSays("runs/s"));
  EXPECT_TRUE(LiveSays("Workers"));
  EXPECT_TRUE(NewsSay("more runs are stored"));
  EXPECT_TRUE(browser_->Becomes("document.querySelector('#live img').naturalWidth > 0"));
  master->Signal(SIGKILL);
  master->Wait();
  EXPECT_TRUE(LiveSays("The campaign stands still"));
  EXPECT_TRUE(LiveSays("gauntlet resume " + dir));
  master = StartGauntlet({"resume", dir, "--quiet"});
  EXPECT_TRUE(LiveSays("The campaign is running"));
  master->Signal(SIGTERM);
  EXPECT_EQ(master->Wait().exit_code, 3);
  EXPECT_TRUE(LiveSays("The campaign stands still"));
  EXPECT_THAT(browser_->complaints(), IsEmpty());
}

TEST_F(ServedPagesInBrowserTest, AFinishedCampaignIsToldSo) {
  const Ui ui(Campaign());
  browser_->Open(ui.address() + "#live");
  EXPECT_TRUE(LiveSays("The campaign has finished"));
  EXPECT_THAT(Live(), Not(HasSubstr("Nothing runs")));
}

TEST_F(ServedPagesInBrowserTest, PagesSayWhenTheirCampaignOrServerIsGone) {
  const std::string dir = Scratch() / "deleted";
  fs::copy(Campaign(), dir, fs::copy_options::recursive);
  Ui ui(dir);
  browser_->Open(ui.address());
  EXPECT_TRUE(browser_->Becomes("document.getElementById('news') !== null"));
  fs::remove_all(dir);
  EXPECT_TRUE(NewsSay("was read before"));
  EXPECT_THAT(ui.Get(ui.root()), StartsWith("HTTP/1.1 410"));
  ui.process().Signal(SIGTERM);
  ui.process().Wait();
  EXPECT_TRUE(NewsSay("Nobody serves these pages any more"));
}

}  // namespace
}  // namespace gauntlet::testing_support
