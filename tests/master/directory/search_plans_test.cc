#include "master/directory/search_plans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

class SearchPlansTest : public testing::Test {
 protected:
  void SetUp() override {
    dir_ = std::filesystem::path(testing::TempDir()) /
           (std::string("gauntlet-plans-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(dir_);
    std::ofstream(dir_ / "campaign.db") << "";
  }
  void TearDown() override { std::filesystem::remove_all(dir_); }
  Result<std::vector<SearchPlan>> Read() const {
    return ReadSearchPlans(CampaignDirectory::Open(dir_.string()).value());
  }
  void Write(const std::string& name, const std::string& text) const { std::ofstream(dir_ / name) << text; }

  std::filesystem::path dir_;
};

TEST_F(SearchPlansTest, ReadBackEqual) {
  const Experiment base = LoadExperiment("flocking", {}, BuiltInCatalogue()).value();
  Experiment other = base;
  other.seed = 18446744073709551615U;
  other.search.population = 6;
  Write("searches.json", WriteSearchPlans({{"seed 1", base}, {"all \"others\"", other}}));
  const Result<std::vector<SearchPlan>> plans = Read();
  ASSERT_TRUE(plans.ok()) << plans.error().message;
  ASSERT_EQ(plans->size(), 2U);
  EXPECT_EQ((*plans)[0].id, 1U);
  EXPECT_EQ((*plans)[1].id, 2U);
  EXPECT_EQ((*plans)[1].settings, "all \"others\"");
  EXPECT_EQ(WriteExperiment((*plans)[0].experiment, {}, BuiltInCatalogue()),
            WriteExperiment(base, {}, BuiltInCatalogue()));
  EXPECT_EQ(WriteExperiment((*plans)[1].experiment, {}, BuiltInCatalogue()),
            WriteExperiment(other, {}, BuiltInCatalogue()));
}

TEST_F(SearchPlansTest, WithoutAListThereIsTheOneExperiment) {
  Write("experiment.toml", WriteExperiment(LoadExperiment("flocking", {"seed=5"}, BuiltInCatalogue()).value(),
                                           {}, BuiltInCatalogue()));
  const Result<std::vector<SearchPlan>> plans = Read();
  ASSERT_TRUE(plans.ok()) << plans.error().message;
  ASSERT_EQ(plans->size(), 1U);
  EXPECT_EQ((*plans)[0].id, 1U);
  EXPECT_EQ((*plans)[0].settings, "");
  EXPECT_EQ((*plans)[0].experiment.seed, 5U);
}

TEST_F(SearchPlansTest, ADamagedListIsNamed) {
  for (const char* text :
       {"", "{", "[]", R"({"format": 2, "searches": []})", R"({"format": 1, "searches": []})",
        R"({"format": 1, "searches": [{"settings": "x"}]})",
        R"({"format": 1, "searches": [{"settings": "x", "experiment": "seed = -1"}]})"}) {
    Write("searches.json", text);
    const Result<std::vector<SearchPlan>> plans = Read();
    ASSERT_FALSE(plans.ok()) << text;
    EXPECT_THAT(plans.error().message, HasSubstr("searches.json")) << text;
  }
}

}  // namespace
}  // namespace gauntlet
