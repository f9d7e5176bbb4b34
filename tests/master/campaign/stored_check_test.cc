// Every damage that a database can carry unnoticed by SQLite, one at a time.
#include "master/campaign/stored_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "proto/run_codec.h"
#include "tests/master/session/toy_campaign.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;
using testing_support::MemoryStore;

struct Damage {
  std::string name;
  std::function<void(MemoryStore&)> inflict;
  std::string message;
};

void PrintTo(const Damage& damage, std::ostream* os) {
  *os << damage.name;
}

// Changes run 5, and says nothing to the rest.
std::function<void(MemoryStore&)> ToRun5(const std::function<void(StoredRun&)>& change) {
  return [change](MemoryStore& store) { change(store.runs.at(5)); };
}

std::string SpecWith(const StoredRun& run, const std::function<void(sim::RunSpec&)>& change) {
  sim::RunSpec spec = proto::DecodeRunSpec(run.spec).value();
  change(spec);
  return proto::EncodeRunSpec(spec);
}

const Experiment& Toy() {
  static const Experiment experiment = ToyExperiment();
  return experiment;
}

const std::vector<Damage>& Damages() {
  static const std::vector<Damage> damages = {
      {"FitnessInTheRow", ToRun5([](StoredRun& run) { run.fitness = 0.5; }),
       "run 5 has fitness 0.5 in its row"},
      {"HashInTheRow", ToRun5([](StoredRun& run) { ++run.hash; }), "run 5 has hash"},
      {"VerdictInTheRow", ToRun5([](StoredRun& run) { run.verdict = sim::Verdict::kCrashed; }),
       "run 5 has verdict 3 in its row, 'completed' in its result"},
      {"FailureInTheRow", ToRun5([](StoredRun& run) { run.total_failure = !run.total_failure; }),
       "run 5 has total_failure"},
      {"FailureTypeInTheRow", ToRun5([](StoredRun& run) { run.failure_type = 11; }),
       "run 5 has failure_type 11 in its row"},
      {"ResultThatDoesNotDecode", ToRun5([](StoredRun& run) { run.result = "\x07"; }),
       "the result of run 5: "},
      {"ByteOfTheResult",
       ToRun5([](StoredRun& run) { run.result.back() = static_cast<char>(~run.result.back()); }), "run 5"},
      {"SpecAlone", ToRun5([](StoredRun& run) {
         run.spec = SpecWith(run, [](sim::RunSpec& spec) { spec.controller_parameters["gain"] = 2.0; });
       }),
       "the spec of run 5 has hash"},
      {"SpecAndItsHash", ToRun5([](StoredRun& run) {
         run.spec = SpecWith(run, [](sim::RunSpec& spec) { spec.test_case.side_x += 1.0; });
         run.spec_hash = SpecHash(run.spec);
       }),
       "is not the one that run 5 simulated"},
      {"Seed", ToRun5([](StoredRun& run) { ++run.seed; }), "run 5 has seed"},
      {"Individual", ToRun5([](StoredRun& run) { run.individual = 77; }), "of individual 77 has"},
      {"Replicate", ToRun5([](StoredRun& run) { run.replicate += 3; }), "run 5 has seed"},
      {"MissingRun", [](MemoryStore& store) { store.runs.erase(5); }, "run 5 is missing"},
      {"MissingLastRun", [](MemoryStore& store) { store.runs.erase(std::prev(store.runs.end())); },
       "is missing"},
      {"TestCase",
       [](MemoryStore& store) { store.individuals.at(kOnlySearch).at(2).test_case.obstacles.at(0).x += 0.1; },
       "the stored test case of individual 3"},
      {"StatesOfAFinishedSearch", [](MemoryStore& store) { store.states.clear(); }, "its states are missing"},
      {"NewestStateOfAFinishedSearch", [](MemoryStore& store) { store.states.at(kOnlySearch).pop_back(); },
       "the newest state has seen only the runs up to"}};
  return damages;
}

class DamageTest : public testing::TestWithParam<Damage> {};

TEST_P(DamageTest, IsFoundAndNamed) {
  MemoryStore store = FinishedToyCampaign({Toy()});
  const Status before = CheckStored(PlansOf({Toy()}), store);
  ASSERT_TRUE(before.ok()) << before.error().message;
  GetParam().inflict(store);
  const Status after = CheckStored(PlansOf({Toy()}), store);
  ASSERT_FALSE(after.ok());
  EXPECT_EQ(after.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(after.error().message, HasSubstr("the campaign's database was changed or is damaged: "));
  EXPECT_THAT(after.error().message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(CheckStored, DamageTest, testing::ValuesIn(Damages()),
                         [](const testing::TestParamInfo<Damage>& one) { return one.param.name; });

TEST(CheckStoredTest, ACampaignThatWasInterruptedAnywhereIsWhole) {
  for (std::size_t results = 1; results < 40; results += 7) {
    MemoryStore store;
    ToySession session({Toy()}, store);
    session.backend.next = [](std::size_t running) { return running - 1; };
    const Result<CampaignEnd> end =
        session.Run([&] { return store.runs.size() >= results ? StopWish::kNow : StopWish::kNone; });
    ASSERT_TRUE(end.ok());
    const Status whole = CheckStored(PlansOf({Toy()}), store);
    EXPECT_TRUE(whole.ok()) << results << ": " << whole.error().message;
  }
}

TEST(CheckStoredTest, EverySearchOfASweepIsCheckedByItsOwnExperiment) {
  const std::vector<SearchPlan> plans = PlansOf({ToyExperiment(1), ToyExperiment(2)});
  MemoryStore store = FinishedToyCampaign({ToyExperiment(1), ToyExperiment(2)});
  EXPECT_TRUE(CheckStored(plans[1], store).ok());
  SearchPlan other = plans[1];
  other.experiment = plans[0].experiment;
  EXPECT_FALSE(CheckStored(other, store).ok()) << "the seeds are of another experiment";
  store.runs.at(RunIdOf(2, 4)).fitness = -1.0;
  EXPECT_TRUE(CheckStored(plans[0], store).ok());
  EXPECT_FALSE(CheckStored(plans[1], store).ok());
}

}  // namespace
}  // namespace gauntlet
