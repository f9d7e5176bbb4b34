#include "study/questions/chosen_cases.h"

#include <gtest/gtest.h>

#include "search/search_table.h"
#include "tests/study/questions/answering.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

TEST(ChooseCases, DrawsThoseThatRandomSearchSimulates) {
  const ChosenCases chosen = ChooseCases("random:30", testing_support::Flocking({"seed=7"})).value();
  EXPECT_EQ(chosen.words, "30 random cases of seed 7");
  ASSERT_EQ(chosen.groups.size(), 1U);
  EXPECT_FALSE(chosen.groups[0].related);
  const auto search =
      MakeSearch(testing_support::Flocking({"seed=7", "search.algorithm=random", "search.cases=30"})).value();
  const auto requests = search->Ask();
  ASSERT_EQ(chosen.groups[0].cases.size(), 30U);
  for (std::size_t i = 0; i < requests.size(); ++i)
    EXPECT_EQ(CaseHash(chosen.groups[0].cases[i]), CaseHash(requests[i].test_case)) << i;
  EXPECT_EQ(chosen.groups[0].cases[29].name, "random 30");
}

TEST(ChooseCases, DrawsMoreThanASearchAsksForAtOnce) {
  EXPECT_EQ(DrawRandomCases(testing_support::Flocking(), 5000).value().size(), 5000U);
}

TEST(ChooseCases, SaysWhatIsWrong) {
  for (const char* wrong : {"random:", "random:0", "random:x", "random:-1", "random:1000001"}) {
    EXPECT_EQ(ChooseCases(wrong, testing_support::Flocking()).error().message,
              std::string("--on ") + wrong + ": a whole number from 1 to 1,000,000 is needed");
  }
  EXPECT_FALSE(ChooseCases("corpus:/nowhere", testing_support::Flocking()).ok());
  EXPECT_EQ(ChooseCases("/nowhere:final", testing_support::Flocking()).error().message.substr(0, 5), "--on ");
}

}  // namespace
}  // namespace gauntlet
