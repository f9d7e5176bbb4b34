// Covers: report/pages/base64.cc, report/pages/report_page.cc
#include "report/pages/report_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include <nlohmann/json.hpp>

#include "report/pages/report_page.h"
#include "tests/report/pages/facts.h"

namespace gauntlet {
namespace {

using nlohmann::ordered_json;
using ::testing::HasSubstr;
using ::testing::Not;

// Two robots over `ticks` ticks, the first one driving from the arena's lower left corner.
analysis::RunFigure FigureOf(int ticks) {
  analysis::RunFigure figure;
  figure.run = "run 7";
  for (int tick = 0; tick <= ticks; ++tick) {
    figure.result.trajectory.push_back({{-3.0 + 0.001 * tick, -3.0, 0.0, 0.01}, {1.0, 2.0, 3.0, 0.0}});
  }
  figure.result.robots.resize(2);
  figure.result.robots[1].lost = true;
  return figure;
}

TEST(ReplayDocumentTest, HoldsEveryPoseInFourBytes) {
  const ordered_json json = ReplayDocument(FigureOf(1));
  EXPECT_EQ(json["robots"], 2);
  EXPECT_EQ(json["times"], ordered_json({0.0, 0.1}));
  // The corner is 0, 0; heading 0 lies in the middle of the turn: bytes 0, 0, 0, 128.
  EXPECT_THAT(json["poses"].get<std::string>(), testing::StartsWith("AAAAg"));
  EXPECT_EQ(json["poses"].get<std::string>().size(), 24U) << "16 bytes in base64";
  EXPECT_EQ(json["last"][1], ordered_json({1.0, 2.0, 3.0}));
  EXPECT_EQ(json["lost"], ordered_json({false, true}));
}

TEST(ReplayDocumentTest, ALongRunIsThinnedButKeepsItsEnd) {
  const ordered_json json = ReplayDocument(FigureOf(30'000));
  EXPECT_LE(json["times"].size(), 5'001U);
  EXPECT_EQ(json["times"].back(), 3'000.0);
  EXPECT_DOUBLE_EQ(json["last"][0][0].get<double>(), 27.0);
}

CampaignPages PagesWithNames(const std::string& name) {
  CampaignPages pages{FactsOf("flocking"), {}, {}, {}};
  pages.facts.directory = name;
  pages.facts.notes = {name};
  pages.facts.experiment_toml = name;
  pages.facts.summary.experiment = name;
  pages.facts.summary.searches.resize(1);
  pages.facts.summary.runs_done = 1;
  pages.facts.runs = {RunOf(1, 0.0, 3)};
  pages.facts.cases = {
      {.search = 1, .individual = 1, .name = name, .runs = 1, .fitness = FitnessOf(0.0), .toughest = 1}};
  pages.courses = CoursesOf(pages.facts);
  pages.maps = MapsOf(pages.facts);
  return pages;
}

TEST(ReportDocumentTest, ACaseIsARowOfItsColumns) {
  CampaignPages pages = PagesWithNames("x");
  pages.facts.cases.push_back({.search = 1, .individual = 2, .runs = 1});
  const ordered_json campaign = ReportDocument({{pages}, {}})["campaigns"][0];
  ASSERT_EQ(campaign["cases"].size(), 2U);
  for (const ordered_json& row : campaign["cases"]) EXPECT_EQ(row.size(), campaign["case_columns"].size());
  EXPECT_EQ(campaign["case_columns"][3]["key"], "mean");
  EXPECT_EQ(campaign["cases"][0][3], 0.0);
  EXPECT_TRUE(campaign["cases"][1][3].is_null()) << "no fitness";
}

TEST(ReportPageTest, NamesAreTextEverywhere) {
  const std::string evil = "</script><script>evil()</script><img src=x onerror=evil()>";
  const std::string page = ReportPage({{PagesWithNames(evil)}, {}});
  EXPECT_THAT(page, Not(HasSubstr("<script>evil")));
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  EXPECT_THAT(page, HasSubstr("&lt;img src=x"));
}

TEST(ReportPageTest, ForbidsTheNetworkAndNamesNoOther) {
  const std::string page = ReportPage({{PagesWithNames("x")}, {}});
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  for (const char* reference : {"src=\"http", "href=\"http", "@import", "url("})
    EXPECT_THAT(page, Not(HasSubstr(reference)));
}

TEST(VerdictTest, SaysWhatCameOfIt) {
  CampaignPages pages = PagesWithNames("x");
  pages.facts.summary.failing_runs = 1;
  pages.facts.cases.front().total_failures = 1;
  pages.facts.summary.searches.front().population = {{.id = 1, .runs = {1}, .failing_runs = 1}};
  EXPECT_EQ(VerdictOf(pages),
            "The swarm of birds broke: it failed in 1 of 1 runs (100.0 %). The toughest test "
            "case, that of run 1, made it fail in 1 of 1 runs. How often it fails without any obstacle is "
            "not known: "
            "gauntlet baseline x looks.");
  pages.facts.summary.failing_runs = 0;
  EXPECT_EQ(VerdictOf(pages), "The swarm of birds held out: in none of 1 runs did it fail.");
  pages.facts.summary.runs_failed = 1;
  EXPECT_EQ(VerdictOf(pages), "No run gave a result: of 1 runs none could be simulated to its end.");
  pages.facts.summary.runs_done = 0;
  EXPECT_EQ(VerdictOf(pages), "Nothing has been simulated yet.");
}

TEST(ReplayDocumentTest, AnArenaElsewhereHasTheSameBytesAndItsCentre) {
  analysis::RunFigure figure = FigureOf(8);
  const ordered_json json = ReplayDocument(figure);
  EXPECT_FALSE(json.contains("center"));
  figure.spec.test_case.center = {-16.0, 64.0};
  for (auto& tick : figure.result.trajectory) {
    for (sim::RobotState& state : tick) {
      state.x -= 16.0F;
      state.y += 64.0F;
    }
  }
  const ordered_json moved = ReplayDocument(figure);
  EXPECT_EQ(moved["center"], ordered_json({-16.0, 64.0}));
  EXPECT_EQ(moved["poses"], json["poses"]);
}

}  // namespace
}  // namespace gauntlet
