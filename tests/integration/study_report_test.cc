// What `study` and `tune` have found, as pages of a report and as figures.
// Covers: cli/output/study_output.cc, report/figures/study_figures.cc, report/pages/study_html.cc,
// study/study_tables.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/integration/browser.h"
#include "tests/integration/campaign_driver.h"
#include "tests/integration/shown_campaign.h"
#include "tests/integration/ui_driver.h"

namespace gauntlet::testing_support {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr const char* kCandidates = R"(
name = "small"
[tune.small]
title = "a <b>small</b> tuning"
experiment = "flocking"
repeats = 9
sizes = "1, 5, 50"
set.search.population = 4
set.search.generations = 3
candidates.genome.genes = "1, 8"
)";

constexpr const char* kStudy = R"(
name = "small"
description = "two evolutions against random cases"
[part.evolved]
kind = "evolve"
experiment = "flocking"
seeds = "1..2"
set.search.population = 6
set.search.generations = 4
[part.random]
kind = "random"
experiment = "flocking"
cases = 40
[part.again]
kind = "evaluate"
from = "evolved"
[compare.severity]
title = "evolved against random"
first = "again"
second = "random:all"
expect = "less"
)";

// Six evolutions of each of two values.
const std::string& TuningDirectory() {
  static const std::string dir = [] {
    std::ofstream(Scratch() / "tune.toml") << kCandidates;
    const std::string path = Scratch() / "tuning";
    const ProcessResult made = Gauntlet({"tune", "flocking", "--candidates", Scratch() / "tune.toml",
                                         "--repeats", "6", "--dir", path, "--workers", "2", "--quiet"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return path;
  }();
  return dir;
}

const std::string& StudyDirectory() {
  static const std::string dir = [] {
    std::ofstream(Scratch() / "study.toml") << kStudy;
    const std::string path = Scratch() / "study";
    const ProcessResult made =
        Gauntlet({"study", Scratch() / "study.toml", "--dir", path, "--workers", "2", "--quiet"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return path;
  }();
  return dir;
}

std::string ReportOf(const std::string& dir, const std::string& name) {
  std::string path = Scratch() / name;
  const ProcessResult made = Gauntlet({"report", dir, "-o", path, "--runs", "2"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  return path;
}

TEST(StudyFigureTest, ATuningHasTwoWithTheirData) {
  EXPECT_EQ(Gauntlet({"figure", TuningDirectory()}).out,
            "  name         figure\n"
            "  robustness   What each value of a parameter does\n"
            "  consistency  How many repeats are enough\n");
  const std::string csv = Scratch() / "robustness.csv";
  const std::string svg = Scratch() / "robustness.svg";
  ASSERT_EQ(Gauntlet({"figure", TuningDirectory(), "robustness", "-o", svg, "--csv", csv}).exit_code, 0);
  EXPECT_EQ(ReadFile(svg), ReadFile(TuningDirectory() + "/robustness.svg")) << "as `tune` has left it";
  const std::string data = ReadFile(csv);
  EXPECT_EQ(std::ranges::count(data, '\n'), 3) << "names, and a row for each value";
  EXPECT_EQ(data,
            "parameter,value,baseline,evolutions,simulations each,median,mean,A,A low,A high,p (Holm)\n"
            "genome.genes,1,FALSE,6,12,0.9861436477466274,0.9057787132865034,0.027777777777777776,0,0."
            "16666666666666666,0.004329004329004328\n"
            "genome.genes,8,TRUE,6,12,0.08140813243560155,0.1990270189898435,,,,\n");
  const ProcessResult wrong = Gauntlet({"figure", TuningDirectory(), "progress"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.err, "gauntlet: there is no figure 'progress'; there are: robustness, consistency\n");
}

TEST(StudyFigureTest, AComparisonHasItsBoxPlotsAndEveryValue) {
  const std::string csv = Scratch() / "severity.csv";
  ASSERT_EQ(Gauntlet({"figure", StudyDirectory(), "severity", "--csv", csv}).exit_code, 0);
  EXPECT_EQ(std::ranges::count(ReadFile(csv), '\n'), 1 + 12 + 40);
}

TEST(StudyReportTest, AStudyThatHasNotFinishedSaysSo) {
  const std::string dir = Scratch() / "half";
  fs::copy(TuningDirectory(), dir, fs::copy_options::recursive);
  fs::remove_all(dir + "/evaluations");
  const std::string page = ReadFile(ReportOf(dir, "half.html"));
  EXPECT_NE(page.find("It has not finished"), std::string::npos);
  EXPECT_NE(page.find("gauntlet resume " + dir), std::string::npos);
  EXPECT_EQ(page.find("id=\"parameters\""), std::string::npos);
  EXPECT_EQ(Gauntlet({"figure", dir, "robustness"}).exit_code, 2);
  fs::remove_all(dir + "/searches");
  const ProcessResult nothing = Gauntlet({"report", dir, "-o", Scratch() / "nothing.html"});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_EQ(nothing.err, "gauntlet: " + (Scratch() / "half") +
                             " holds a study that has not begun: `gauntlet resume " + (Scratch() / "half") +
                             "` begins it\n");
}

class StudyReportInBrowserTest : public testing::Test {
 protected:
  void SetUp() override {
    if (BrowserPath().empty()) GTEST_SKIP() << "there is no Chromium here (package chromium-headless-shell)";
    browser_ = std::make_unique<Browser>();
  }
  std::string Text(const std::string& page) {
    return browser_->Evaluate("document.getElementById('" + page + "').innerText");
  }
  // Of the pictures of a page.
  json Widths(const std::string& page) {
    return browser_->Evaluate("[...document.querySelectorAll('#" + page + " img')].map(i => i.naturalWidth)");
  }
  std::unique_ptr<Browser> browser_;
};

TEST_F(StudyReportInBrowserTest, ATuningLeadsFromItsRecommendationToWhatWasTried) {
  browser_->Open("file://" + ReportOf(TuningDirectory(), "tuning.html"));
  EXPECT_THAT(Text("overview"), HasSubstr("Recommended: the baseline as it is."));
  browser_->Evaluate("document.querySelector('#overview a[href=\"#parameters\"]').click()");
  ASSERT_TRUE(browser_->Becomes("document.getElementById('parameters').classList.contains('shown')"));
  EXPECT_THAT(Text("parameters"),
              AllOf(HasSubstr("a <b>small</b> tuning"), HasSubstr("Recommended: the baseline as it is."),
                    HasSubstr("8 stays"), HasSubstr("Easier beyond chance: 1"),
                    HasSubstr("Enough repeats: 50"), HasSubstr("A row for each value of a parameter")));
  EXPECT_THAT(Widths("parameters"), AllOf(SizeIs(2), Each(testing::Gt(0))));
  browser_->SetWidth(320);
  EXPECT_LE(browser_->Evaluate("document.documentElement.scrollWidth").get<int>(), 320);
  EXPECT_THAT(browser_->complaints(), IsEmpty());
  EXPECT_THAT(browser_->requests(), SizeIs(1)) << "the file itself";
}

TEST_F(StudyReportInBrowserTest, WithoutJavaScriptATuningIsThere) {
  browser_->Open("file://" + ReportOf(TuningDirectory(), "tuning.html"), /*scripts=*/false);
  EXPECT_THAT(Text("parameters"), AllOf(HasSubstr("Recommended"), HasSubstr("95 % interval")));
  EXPECT_GT(browser_->Evaluate("document.getElementById('parameters').offsetHeight").get<int>(), 0);
}

TEST_F(StudyReportInBrowserTest, AStudyShowsWhatItComparedWithTheTestBesideIt) {
  browser_->Open("file://" + ReportOf(StudyDirectory(), "study.html") + "#comparison");
  EXPECT_THAT(Text("comparison"),
              AllOf(HasSubstr("evolved against random"), HasSubstr("One-tailed p"), HasSubstr("random:all")));
  EXPECT_THAT(Widths("comparison"), SizeIs(1));
  browser_->Evaluate("location.hash = '#overview'");
  EXPECT_THAT(Text("overview"), HasSubstr("two evolutions against random cases"));
  EXPECT_THAT(browser_->complaints(), IsEmpty());
}

TEST_F(StudyReportInBrowserTest, ServedPagesTellOfATuningWhoseSecondPartBegins) {
  const std::string dir = Scratch() / "going";
  fs::copy(TuningDirectory(), dir, fs::copy_options::recursive);
  fs::rename(dir + "/evaluations", dir + "/later");
  const Ui ui(dir);
  browser_->Open(ui.address());
  EXPECT_THAT(Text("overview"), HasSubstr("It has not finished"));
  fs::rename(dir + "/later", dir + "/evaluations");
  EXPECT_TRUE(browser_->Becomes("(document.getElementById('news')?.innerText ?? '').includes('has begun')"));
  browser_->Open(ui.address() + "#parameters");
  EXPECT_THAT(Text("parameters"), HasSubstr("Recommended"));
  EXPECT_THAT(browser_->complaints(), IsEmpty());
}

}  // namespace
}  // namespace gauntlet::testing_support
