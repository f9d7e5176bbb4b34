#include "study/questions/corpus_experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/study/questions/answering.h"

namespace gauntlet {
namespace {

using namespace testing_support;  // NOLINT(google-build-using-namespace)

CorpusEntry Entry() {
  CorpusEntry entry{"corpus/a.json", {}};
  entry.content.settings = SettingsOf(Flocking({"controller_parameters.bird_speed=0.1"}));
  return entry;
}

TEST(CorpusExperiment, IsReadBackFromItsSettings) {
  const Experiment experiment = ExperimentOf(Entry(), {}, {}).value();
  EXPECT_EQ(experiment.scenario, "flocking");
  EXPECT_EQ(experiment.controller_parameters.at("bird_speed"), 0.1);
  EXPECT_EQ(SettingsOf(experiment), Entry().content.settings);
  // Another controller has parameters of its own.
  EXPECT_EQ(ExperimentOf(Entry(), {"controller=flocking-improved"}, {}).value().controller,
            "flocking-improved");
}

TEST(CorpusExperiment, OfAControllerThatNobodyKnowsThePlugInIsAskedFor) {
  CorpusEntry entry = Entry();
  for (auto& [key, value] : entry.content.settings) {
    if (key == "controller") value = "wall-bird";
  }
  const auto refused = ExperimentOf(entry, {}, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message,
              testing::EndsWith("; --plugin LIB.so names the library of one that a plug-in brings, --plugin "
                                "NAME.toml the experiment of one that a program simulates"));
}

}  // namespace
}  // namespace gauntlet
