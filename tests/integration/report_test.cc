// gauntlet report and gauntlet figure on real campaigns; the report in a real browser.
// Covers: analysis/figures/run/run_thumbnail.cc, cli/commands/figure_command.cc,
// cli/commands/report_command.cc, report/figures/campaign_figures.cc, report/figures/replayed_figure.cc,
// report/pages/answers_html.cc, report/pages/campaign_pages.cc, report/pages/case_html.cc,
// report/pages/failures_html.cc, report/pages/overview_html.cc, report/pages/verdict_sentence.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/integration/browser.h"
#include "tests/integration/campaign_database.h"
#include "tests/integration/campaign_driver.h"
#include "tests/integration/replayed_poses.h"
#include "tests/integration/shown_campaign.h"

namespace gauntlet::testing_support {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::string MakeReport(const std::vector<std::string>& sets, const std::string& name) {
  const std::string path = Scratch() / name;
  std::vector<std::string> arguments = {"report"};
  arguments.insert(arguments.end(), sets.begin(), sets.end());
  arguments.insert(arguments.end(), {"-o", path, "--runs", "6"});
  const ProcessResult result = Gauntlet(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  return path;
}
const std::string& OneReport() {
  static const std::string path = MakeReport({Campaign()}, "report.html");
  return path;
}

// Megabytes, which no failure should print.
bool Says(const std::string& report, const std::string& text) {
  return ReadFile(report).find(text) != std::string::npos;
}

TEST(FigureTest, WritesPictureAndDataOfTheSameThing) {
  const std::string svg = Scratch() / "types.svg";
  const std::string csv = Scratch() / "types.csv";
  const ProcessResult result = Gauntlet({"figure", Campaign(), "failure-types", "-o", svg, "--csv", csv});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(ReadFile(csv));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(
      line,
      "their speeds,degrees between the headings of the two groups at the last split,runs,toughest run");
  std::uint64_t counted = 0;
  int rows = 0;
  while (std::getline(lines, line)) {
    ++rows;
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; i < 3; ++i) std::getline(cells, cell, ',');
    counted += std::stoull(cell);
  }
  EXPECT_EQ(rows, 20);
  std::uint64_t typed = 0;
  const json shown = Show(Campaign());
  for (const json& type : shown["failure_types"]) typed += type["runs"].get<std::uint64_t>();
  EXPECT_GT(typed, 0U);
  EXPECT_EQ(counted, typed);
}

TEST(FigureTest, SetsOfRunsAreComparedByBoxPlots) {
  const std::string csv = Scratch() / "boxes.csv";
  const std::string svg = Scratch() / "boxes.svg";
  const ProcessResult result = Gauntlet({"figure", Campaign() + ":all", "comparison", "--with",
                                         Campaign() + ":worst:10", "-o", svg, "--csv", csv});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(ReadFile(svg), HasSubstr("campaign:all against "));
  const std::string data = ReadFile(csv);
  EXPECT_EQ(std::ranges::count(data, '\n'), 1 + 60 + 10);
  const ProcessResult alone = Gauntlet({"figure", Campaign(), "comparison"});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_EQ(alone.err,
            "gauntlet: these sets are not of one scenario: name at least two that are, the first in place of "
            "DIR and each other one by --with\n");
}

TEST(FigureTest, NamesWhatThereIs) {
  EXPECT_EQ(Gauntlet({"figure", Campaign()}).out,
            "  name           figure\n"
            "  failure-types  Types of total failure\n"
            "  behaviour      How the swarms behaved\n"
            "  comparison     with --with SET: box plots of several sets of runs\n"
            "  run-ID         of a run: every robot's trajectory\n"
            "  motion-ID      of a run: how the swarm moved, over time\n"
            "  states-ID      of a run: what every robot did when (foraging, task-partitioning)\n");
  const ProcessResult wrong = Gauntlet({"figure", Campaign(), "progres"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.err,
            "gauntlet: there is no figure 'progres'; there are: failure-types, behaviour, "
            "comparison, run-ID, motion-ID, states-ID\n");
  EXPECT_EQ(Gauntlet({"figure", Campaign(), "run-0"}).exit_code, 2);
  EXPECT_EQ(Gauntlet({"figure", Campaign(), "run-61"}).exit_code, 2);
  EXPECT_THAT(Gauntlet({"figure", Campaign(), "motion-1"}).out, HasSubstr("</svg>"));
}

TEST(ReportTest, IsTheSameBytesForTheSameCampaign) {
  EXPECT_TRUE(ReadFile(OneReport()) == ReadFile(MakeReport({Campaign()}, "again.html")));
}

TEST(ReportTest, BadInputIsNamedAndLeavesNoFile) {
  const std::string out = Scratch() / "none.html";
  const ProcessResult nothing = Gauntlet({"report", Scratch() / "nothing", "-o", out});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_EQ(nothing.err, "gauntlet: " + (Scratch() / "nothing") +
                             ": no such campaign or CSV file (DIR, DIR:final, DIR:all, DIR:random:100, "
                             "DIR:search:2:final, FILE.csv:COLUMN)\n");
  const std::string damaged = Scratch() / "damaged";
  fs::copy(Campaign(), damaged, fs::copy_options::recursive);
  fs::resize_file(damaged + "/campaign.db", 4096 * 3);
  const ProcessResult broken = Gauntlet({"report", damaged, "-o", out});
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_EQ(broken.err, "gauntlet: " + (Scratch() / "damaged/campaign.db") +
                            " is damaged (database disk image is malformed); it was left as it is\n");
  const std::string newer = Scratch() / "newer";
  fs::copy(Campaign(), newer, fs::copy_options::recursive);
  AlterDatabase(newer, "PRAGMA user_version = 999");
  const ProcessResult other = Gauntlet({"report", newer, "-o", out});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.err, "gauntlet: " + (Scratch() / "newer/campaign.db") +
                           " has format 999, made by a newer gauntlet; this one reads format 3: use the "
                           "newer version (nothing was changed)\n");
  EXPECT_FALSE(fs::exists(out));
}

TEST(ReportTest, ACampaignThatIsBeingWrittenIsToldOfAsFarAsItIs) {
  const std::string dir = Scratch() / "living";
  const auto master = StartGauntlet({"random", "flocking", "--cases", "100000", "--dir", dir, "--quiet"});
  const auto has_runs = [&] {
    const ProcessResult shown = Gauntlet({"show", dir, "--json"});
    return shown.exit_code == 0 && json::parse(shown.out)["runs_done"] > 0;
  };
  ASSERT_TRUE(Eventually(has_runs, kPatience));
  EXPECT_TRUE(Says(MakeReport({dir}, "living.html"), "is being written"));
  master->Signal(SIGTERM);
  EXPECT_EQ(master->Wait().exit_code, 3);
  EXPECT_TRUE(Says(MakeReport({dir}, "half.html"), "is half-finished"));
}

TEST(ReportTest, LeadsWithDistinctFailuresAndShowsWhatObstaclesDo) {
  const std::string dir = Scratch() / "questioned";
  fs::copy(Campaign(), dir, fs::copy_options::recursive);
  EXPECT_TRUE(Says(OneReport(), "gauntlet confirm " + Campaign() + " --all-failing")) << "how to find out";
  Gauntlet({"confirm", dir, "--all-failing", "--replicates", "20", "--workers", "2", "--quiet"});
  const json failures = Show(dir)["distinct_failures"];
  ASSERT_GE(failures.size(), 2U);
  const std::string toughest = failures[0]["cases"][0];  // "run 17"
  const std::string run = toughest.substr(toughest.find(' ') + 1);
  ASSERT_EQ(Gauntlet({"minimise", dir, run, "--workers", "2", "--quiet"}).exit_code, 0);
  ASSERT_EQ(Gauntlet({"blame", dir, run, "--replicates", "5", "--workers", "2", "--quiet"}).exit_code, 0);
  const std::string page = ReadFile(MakeReport({dir}, "questioned.html"));
  const std::size_t found = page.find(" with 10 failed runs or more");
  ASSERT_NE(found, std::string::npos);
  EXPECT_LT(found, page.find("What was tested"));
  const std::size_t pictures = page.find("What is left of it");
  ASSERT_NE(pictures, std::string::npos);
  EXPECT_LT(page.rfind("id=\"run-0-" + run + "\"", pictures), pictures) << "on the page of its run";
  EXPECT_NE(page.find("How the case was made smaller", pictures), std::string::npos);
  EXPECT_NE(page.find("Which obstacles are to blame", pictures), std::string::npos);
  EXPECT_NE(page.find("The few obstacles that do it"), std::string::npos);
  EXPECT_LT(page.find("The smallest layouts that break it"), found) << "what is seen first";
  EXPECT_NE(page.find("A typical run of each"), std::string::npos);
}

TEST(ReportTest, SetsOfOneScenarioAreComparedAndThoseOfOthersNamed) {
  const std::string foraging = Scratch() / "foraging";
  ASSERT_EQ(Gauntlet({"random", "foraging", "--cases", "3", "--set", "scenario_parameters.time_limit=40",
                      "--dir", foraging, "--quiet"})
                .exit_code,
            0);
  const std::string page = MakeReport({Campaign() + ":all", Campaign() + ":worst:10", foraging}, "two.html");
  EXPECT_TRUE(Says(page, "id=\"comparison\""));
  EXPECT_TRUE(
      Says(page, "gauntlet figure " + Campaign() + ":all comparison --with " + Campaign() + ":worst:10 -o"));
  EXPECT_TRUE(Says(page, foraging + " stands alone: no other set is of the scenario foraging"));
}

class ReportInBrowserTest : public testing::Test {
 protected:
  void SetUp() override {
    if (BrowserPath().empty()) GTEST_SKIP() << "there is no Chromium here (package chromium-headless-shell)";
    browser_ = std::make_unique<Browser>();
  }
  std::unique_ptr<Browser> browser_;
};

TEST_F(ReportInBrowserTest, OpensWithoutComplaintAndAsksTheNetworkForNothing) {
  browser_->Open("file://" + OneReport());
  for (const json& page :
       browser_->Evaluate("[...document.querySelectorAll('.page')].map(page => page.id)")) {
    browser_->Evaluate("location.hash = '#" + page.get<std::string>() + "'");
    EXPECT_TRUE(
        browser_->Becomes("document.querySelector('.page.shown').id === '" + page.get<std::string>() + "'"));
    EXPECT_EQ(browser_->Evaluate("document.documentElement.scrollWidth > innerWidth"), false) << page;
  }
  EXPECT_THAT(browser_->complaints(), IsEmpty());
  EXPECT_THAT(browser_->requests(), SizeIs(1)) << "the file itself";
}

TEST_F(ReportInBrowserTest, FitsAPhone) {
  browser_->Open("file://" + OneReport());
  browser_->SetWidth(320);
  for (const json& page :
       browser_->Evaluate("[...document.querySelectorAll('.page')].map(page => page.id)")) {
    browser_->Evaluate("location.hash = '#" + page.get<std::string>() + "'");
    EXPECT_TRUE(
        browser_->Becomes("document.querySelector('.page.shown').id === '" + page.get<std::string>() + "'"));
    EXPECT_LE(browser_->Evaluate("document.documentElement.scrollWidth").get<int>(), 320) << page;
  }
}

TEST_F(ReportInBrowserTest, AClickOnAFieldOfTheMapLeadsToItsRunWhichPlaysToItsStoredEnd) {
  browser_->Open("file://" + OneReport());
  browser_->Evaluate("document.querySelector('nav a[href=\"#failures\"]').click()");
  ASSERT_TRUE(browser_->Becomes("document.getElementById('failures').classList.contains('shown')"));
  const std::string target = browser_->Evaluate(
      "(() => { const field = document.querySelector('table.map a'); field.click(); return "
      "field.hash.slice(1); })()");
  ASSERT_TRUE(browser_->Becomes("document.getElementById('" + target + "').classList.contains('shown')"));
  const Poses expected = LastPoses(Campaign(), target.substr(target.rfind('-') + 1));
  const Poses start = ShownPoses(*browser_);
  ASSERT_EQ(start.size(), expected.size());
  ASSERT_TRUE(PlayToTheEnd(*browser_));
  const Poses end = ShownPoses(*browser_);
  double moved = 0.0;
  for (std::size_t robot = 0; robot < expected.size(); ++robot) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(end[robot][i], expected[robot][i], 1e-9) << robot;
    moved += std::hypot(end[robot][0] - start[robot][0], end[robot][1] - start[robot][1]);
  }
  EXPECT_GT(moved, 1.0) << "nobody moved";
  EXPECT_THAT(browser_->complaints(), IsEmpty());
}

TEST_F(ReportInBrowserTest, KeysStepThroughARunAndLinesShowWhoSeesWhom) {
  browser_->Open("file://" + OneReport());
  browser_->Evaluate("location.hash = '#' + document.querySelector('.page.case').id");
  ASSERT_TRUE(browser_->Becomes("document.querySelectorAll('.page.shown .robot').length > 0"));
  const auto press = [&](const std::string& key, bool shift) {
    browser_->Evaluate("document.body.dispatchEvent(new KeyboardEvent('keydown', {key: '" + key +
                       "', bubbles: true, shiftKey: " + (shift ? "true" : "false") + "}))");
    return browser_->Evaluate("document.querySelector('.page.shown input[type=range]').value");
  };
  EXPECT_EQ(press("ArrowRight", true), "10");
  EXPECT_EQ(press("ArrowLeft", false), "9");
  const std::string lines = "document.querySelector('.page.shown .sights').getAttribute('d')";
  EXPECT_EQ(browser_->Evaluate(lines), "");
  browser_->Evaluate("document.querySelector('.page.shown input[type=checkbox]').click()");
  EXPECT_THAT(browser_->Evaluate(lines).get<std::string>(), HasSubstr("L")) << "the flock is together then";
  press(" ", false);
  EXPECT_EQ(browser_->Evaluate("document.querySelector('.page.shown .controls button').textContent"),
            "Pause");
  EXPECT_THAT(browser_->complaints(), IsEmpty());
}

TEST_F(ReportInBrowserTest, TheTableOfCasesSortsAndFilters) {
  browser_->Open("file://" + OneReport() + "#failures");
  const std::string rows = "document.querySelectorAll('.all-cases tbody tr').length";
  EXPECT_EQ(browser_->Evaluate(rows), 60);
  browser_->Evaluate(
      "(() => { const kind = document.querySelector('.all-cases select'); kind.value = 'failing'; "
      "kind.dispatchEvent(new Event('change')); })()");
  EXPECT_EQ(browser_->Evaluate(rows), Show(Campaign())["total_failures"]);
  browser_->Evaluate("document.querySelectorAll('.all-cases th button')[0].click()");
  EXPECT_EQ(
      browser_->Evaluate("(() => { const numbers = [...document.querySelectorAll('.all-cases tbody tr')]"
                         ".map(row => Number(row.cells[0].textContent)); "
                         "return numbers.every((one, i) => i === 0 || numbers[i - 1] <= one); })()"),
      true);
}

TEST_F(ReportInBrowserTest, WithoutJavaScriptEverythingThatMattersIsThere) {
  browser_->Open("file://" + OneReport(), /*scripts=*/false);
  const std::string seen = browser_->Evaluate("document.body.innerText");
  EXPECT_THAT(seen, AllOf(HasSubstr("total failures"), HasSubstr("state hash"), HasSubstr("toughest run")));
  EXPECT_EQ(
      browser_->Evaluate("[...document.querySelectorAll('.page')].every(page => page.offsetHeight > 0)"),
      true);
  EXPECT_GE(browser_->Evaluate("document.querySelectorAll('.all-cases tbody tr').length").get<int>(), 50);
  EXPECT_EQ(
      browser_->Evaluate("[...document.images].every(image => image.complete && (image.naturalWidth > 0 || "
                         "image.loading === 'lazy'))"),
      true);
}

TEST_F(ReportInBrowserTest, NamesWithMarkupAreText) {
  const std::string evil = "</script><script>document.title='owned'</script><img src=x onerror=alert(1)>\"'&";
  const std::string file = Scratch() / "evil.json";
  std::ofstream(file) << json{{"name", evil}, {"obstacles", json::array()}};
  const std::string dir = Scratch() / "<b>bold & 'quoted'";
  ASSERT_EQ(Gauntlet({"evaluate", "flocking", "--case", file, "--dir", dir, "--quiet"}).exit_code, 0);
  browser_->Open("file://" + MakeReport({dir}, "evil.html") + "#failures");
  EXPECT_EQ(browser_->Evaluate("document.title"), "flocking: Gauntlet report");
  EXPECT_EQ(browser_->Evaluate("document.scripts.length"), 2);
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('b').length"), 0);
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('img[src=x]').length"), 0);
  EXPECT_THAT(browser_->Evaluate("document.body.innerText").get<std::string>(),
              HasSubstr("<b>bold & 'quoted'"));
  EXPECT_THAT(browser_->complaints(), IsEmpty());
}

}  // namespace
}  // namespace gauntlet::testing_support
