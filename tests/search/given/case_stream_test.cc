#include "search/given/case_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

SearchSetup StreamSetup() {
  SearchSetup setup = ToySetup();
  SetAlgorithm(setup, "stream");
  return setup;
}

std::unique_ptr<CaseStream> MakeStream(const SearchSetup& setup = StreamSetup()) {
  return CaseStream::Create(setup).value();
}

StreamedCase Wall(double x) {
  StreamedCase one;
  one.test_case.obstacles = {{.x = x, .length = 1, .width = 0.2}};
  return one;
}

void TellAll(CaseStream& stream) {
  for (const EvaluationRequest& request : stream.Ask()) stream.Tell(OutcomeOf(request, 0.5));
}

TEST(CaseStreamTest, AsksForEachCaseOnceInTheOrderOfAdding) {
  const auto stream = MakeStream();
  EXPECT_THAT(stream->Ask(), IsEmpty());
  EXPECT_EQ(stream->Add(Wall(1)), 1U);
  EXPECT_EQ(stream->Add(Wall(2)), 2U);
  const auto asked = stream->Ask();
  ASSERT_THAT(asked, SizeIs(2));
  EXPECT_EQ(asked[1].individual, 2U);
  EXPECT_EQ(asked[1].test_case.obstacles[0].x, 2.0);
  EXPECT_THAT(stream->Ask(), IsEmpty());
  stream->Tell(OutcomeOf(asked[0], 0.5));
  EXPECT_EQ(stream->Add(Wall(3)), 3U);
  EXPECT_THAT(stream->Ask(), SizeIs(1));
}

TEST(CaseStreamTest, HasFinishedWhenItHasEndedAndAllIsTold) {
  const auto stream = MakeStream();
  stream->Add(Wall(1));
  stream->End();
  EXPECT_FALSE(stream->Progress().finished);
  TellAll(*stream);
  EXPECT_TRUE(stream->Progress().finished);
  EXPECT_TRUE(stream->AtBoundary());
}

TEST(CaseStreamTest, KeepsNothingThatIsTold) {
  const auto stream = MakeStream();
  for (int i = 0; i < 100; ++i) {
    stream->Add(Wall(i));
    TellAll(*stream);
  }
  EXPECT_EQ(stream->told(), 100U);
  EXPECT_EQ(stream->open(), 0U);
  EXPECT_THAT(stream->Population(), IsEmpty());
}

// Common random numbers: what is compared under different settings, or by different programs, meets the same.
TEST(CaseStreamTest, SeedsFollowFromCampaignAndCaseAlone) {
  const auto stream = MakeStream();
  const SearchSetup setup = StreamSetup();
  stream->Add(Wall(1));
  stream->Add(Wall(2));
  StreamedCase again = Wall(1);
  again.settings = std::make_shared<Experiment>(setup.experiment);
  stream->Add(std::move(again));
  StreamedCase fresh = Wall(1);
  fresh.seed = 8;
  stream->Add(std::move(fresh));
  const auto asked = stream->Ask();
  const auto seed = [&](std::size_t i) { return RunSeed(setup.experiment, asked[i], 0); };
  EXPECT_NE(seed(0), seed(1));
  EXPECT_EQ(seed(0), seed(2));
  EXPECT_NE(seed(0), seed(3));
  SearchSetup given = ToySetup();
  SetAlgorithm(given, "cases");
  EXPECT_EQ(RunSeed(given.experiment, asked[0], 0), seed(0)) << "as `evaluate --case` has it";
}

TEST(CaseStreamTest, ItsStateSaysHowManyWereTold) {
  const auto stream = MakeStream();
  for (int i = 0; i < 3; ++i) stream->Add(Wall(i));
  stream->End();
  TellAll(*stream);
  CanonicalEncoder encoder;
  stream->Save(encoder);
  const std::string state = encoder.Take();
  const History none = [](const auto&) -> Status { return Ok{}; };

  const auto next = MakeStream();
  CanonicalDecoder decoder(state);
  ASSERT_TRUE(next->Restore(decoder, none).ok()) << "its master needs no run that was told";
  EXPECT_EQ(next->told(), 3U);
  EXPECT_FALSE(next->Progress().finished) << "more may come";
  EXPECT_EQ(next->Add(Wall(9)), 4U);

  SearchSetup known = StreamSetup();
  for (int i = 0; i < 3; ++i) known.cases.push_back(Wall(i).test_case);
  const auto shown = MakeStream(known);
  const History all = [](const auto& visit) -> Status {
    for (IndividualId id = 1; id <= 3; ++id)
      visit(OutcomeOf({.individual = id}, 0.1 * static_cast<double>(id)));
    return Ok{};
  };
  CanonicalDecoder again(state);
  ASSERT_TRUE(shown->Restore(again, all).ok());
  ASSERT_THAT(shown->Population(), SizeIs(3));
  EXPECT_EQ(shown->Population()[1].fitness, 0.2);
}

}  // namespace
}  // namespace gauntlet
