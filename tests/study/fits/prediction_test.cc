#include "study/fits/prediction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/search/fit/toy_fit.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::SizeIs;
using testing_support::TemporaryDirectory;

TEST(PredictionTest, DrawsAreTheSameWhenMoreAreAskedFor) {
  FitResult fit;
  fit.plan = ToyPlan({.vary = kToyVary, .targets = "metric=fitness value=1 n=100", .runs = 5000}).value();
  for (int i = 0; i < 50; ++i) fit.draws.push_back({0.02 * i, 0.5, 0.25});
  const auto few = DrawSettings(fit, 3);
  const auto more = DrawSettings(fit, 5);
  ASSERT_THAT(more, SizeIs(5));
  EXPECT_TRUE(std::equal(few.begin(), few.end(), more.begin()));
  EXPECT_EQ(few[0][2], "controller_parameters.turning_speed_factor=0.25");
}

TEST(PredictionTest, TheFileGrowsDrawByDrawAndIsGoneOnWith) {
  const TemporaryDirectory folder;
  const std::string path = folder / "draws.csv";
  {
    auto file = PredictionFile::Open(path).value();
    EXPECT_EQ(file.size(), 0U);
    ASSERT_TRUE(file.Add({"a=1", "b=2"}, {{"fitness, mean", 0.5}, {"splits", 1.0}}).ok());
    ASSERT_TRUE(file.Add({"a=2", "b=3"}, {{"fitness, mean", 0.75}}).ok());
  }
  auto file = PredictionFile::Open(path).value();
  EXPECT_EQ(file.size(), 2U);
  ASSERT_TRUE(file.Add({"a=3", "b=4"}, {{"fitness, mean", 0.25}}).ok());
  const nlohmann::json ranges = PredictionFile::Open(path)->Ranges(3).ToJson();
  ASSERT_THAT(ranges, SizeIs(2));
  EXPECT_EQ(ranges[0].at("figure"), "fitness, mean");
  EXPECT_EQ(ranges[0].at("draws"), 3);
  EXPECT_EQ(ranges[0].at("lowest"), 0.25);
  EXPECT_EQ(ranges[0].at("median"), 0.5);
  EXPECT_EQ(ranges[0].at("highest"), 0.75);
  EXPECT_EQ(ranges[1].at("draws"), 1);
  EXPECT_EQ(file.Ranges(2).ToJson()[0].at("draws"), 2);
}

TEST(PredictionTest, AFileThatIsNoneIsNamed) {
  const TemporaryDirectory folder;
  for (const char* line : {"2,a,1", "0,settings,x", "1,a,nan", "1,a,word", "1,a"}) {
    std::ofstream(folder / "draws.csv")
        << (std::string(line) == "1,a" ? "draw,name\n" : "draw,name,value\n") << line << "\n";
    const auto file = PredictionFile::Open(folder / "draws.csv");
    ASSERT_FALSE(file.ok()) << line;
    EXPECT_THAT(file.error().message, testing::EndsWith("draws.csv:2: no line draw,name,value in order"));
  }
}

}  // namespace
}  // namespace gauntlet
