// What a campaign's events say of its program.
#include "master/campaign/observed_reproducibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "master/store/event_kinds.h"
#include "tests/support/memory_store.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

ObservedReproducibility Read(const std::string& scenario, std::vector<StoredEvent> events) {
  Experiment experiment;
  experiment.scenario = scenario;
  testing_support::MemoryStore store;
  store.events = std::move(events);
  return ReadReproducibility({{"", experiment}}, store).value();
}

const StoredEvent kAgreed{1, event::kReproducible, "hosts a, b"};
const StoredEvent kDiffered{2, event::kNotReproducible,
                            "run 17 ended differently when it was simulated again on b"};

TEST(ObservedReproducibilityTest, ASimulatorOfOurOwnHasNone) {
  EXPECT_FALSE(Read("flocking", {}).observed());
}

TEST(ObservedReproducibilityTest, IsUnknownUntilSomethingWasSeen) {
  const ObservedReproducibility seen = Read("command", {{1, event::kStart, "master 1"}});
  EXPECT_EQ(seen.state, Reproducible::kUnknown);
  EXPECT_EQ(seen.Name(), "unknown");
  EXPECT_EQ(InWords(seen), "not yet known");
  EXPECT_THAT(seen.Hosts(), IsEmpty());
}

TEST(ObservedReproducibilityTest, NamesTheHostsThatAgreed) {
  const ObservedReproducibility seen = Read("command", {kAgreed});
  EXPECT_EQ(seen.state, Reproducible::kYes);
  EXPECT_EQ(InWords(seen), "yes (hosts a, b)");
  EXPECT_THAT(seen.Hosts(), ElementsAre("a", "b"));
  EXPECT_THAT(Read("command", {{1, event::kReproducible, "host a"}}).Hosts(), ElementsAre("a"));
}

TEST(ObservedReproducibilityTest, TheFirstDifferenceCountsForGood) {
  const StoredEvent later{3, event::kNotReproducible, "run 18 ended differently"};
  for (const auto& events : {std::vector{kAgreed, kDiffered, later}, std::vector{kDiffered, kAgreed}}) {
    const ObservedReproducibility seen = Read("command", events);
    EXPECT_EQ(seen.Name(), "no");
    EXPECT_EQ(InWords(seen), "no (run 17 ended differently when it was simulated again on b)");
    EXPECT_THAT(seen.Hosts(), IsEmpty());
  }
}

TEST(KeepsWaysTest, OfAProgramTheyAreKept) {
  Experiment experiment;
  experiment.scenario = "flocking";
  EXPECT_FALSE(KeepsWays(experiment));
  experiment.store.trajectories = true;
  EXPECT_TRUE(KeepsWays(experiment));
  experiment.store.trajectories = false;
  experiment.scenario = "command";
  EXPECT_TRUE(KeepsWays(experiment));
}

}  // namespace
}  // namespace gauntlet
