// Campaigns that are made longer: they end like those that were that long from the start.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/integration/campaign_database.h"
#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

constexpr const char* kGenerations = "search.generations";

struct Kind {
  SmallCampaign campaign;  // without its length
  std::string key;
  std::vector<std::string> lengths;  // the last is the whole one
};
void PrintTo(const Kind& kind, std::ostream* os) {
  *os << kind.campaign.name;
}

SmallCampaign WithoutLength(SmallCampaign campaign) {
  campaign.generations = 0;
  std::erase_if(campaign.settings, [](const std::string& one) { return one.starts_with("search.cases="); });
  return campaign;
}

SmallCampaign WithLength(SmallCampaign campaign, const std::string& key, const std::string& length) {
  campaign.settings.push_back(key + "=" + length);
  return campaign;
}

std::vector<Kind> Kinds() {
  SmallCampaign best_half;
  best_half.name = "best_half";
  best_half.settings = {"search.parent_selection=AllParent-BestHalf"};
  return {{WithoutLength(SmallCampaign()), kGenerations, {"2", "3", "6"}},
          {WithoutLength(best_half), kGenerations, {"1", "4"}},
          {WithoutLength(SmallSteadyState()), kGenerations, {"2", "3", "6"}},
          {WithoutLength(SmallRandom()), "search.cases", {"30", "1100"}}};
}

std::vector<std::string> Longer(const std::string& dir, const std::string& set, int workers) {
  return {"resume", dir, "--set", set, "--workers", std::to_string(workers), "--quiet"};
}

// Everything that a campaign of any length stores of what it has done: its runs, who was born, and the state
// in which it ended.
std::vector<std::string> Content(const std::string& dir) {
  std::vector<std::string> content =
      Query(dir,
            "SELECT id, individual, evaluation, replicate, generation, seed, verdict, fitness_bits, hash, "
            "spec_hash FROM runs ORDER BY id");
  for (const char* query :
       {"SELECT id, birth_generation, hex(parents) FROM individuals ORDER BY id",
        "SELECT last_run, generation, checksum FROM states ORDER BY last_run DESC LIMIT 1"}) {
    const std::vector<std::string> more = Query(dir, query);
    content.insert(content.end(), more.begin(), more.end());
  }
  return content;
}

class ExtensionTest : public testing::TestWithParam<Kind> {};

TEST_P(ExtensionTest, EndsLikeACampaignThatWasThatLongFromTheStart) {
  const auto& [campaign, key, lengths] = GetParam();
  const TemporaryDirectory scratch;
  const std::string whole = scratch / "whole";
  ASSERT_EQ(Gauntlet(EvolveArguments(WithLength(campaign, key, lengths.back()), whole, 2)).exit_code, 0);
  const std::string dir = scratch / "c";
  ASSERT_EQ(Gauntlet(EvolveArguments(WithLength(campaign, key, lengths.front()), dir, 2)).exit_code, 0);
  ASSERT_NE(StateHash(dir), StateHash(whole));
  int workers = 1;
  for (std::size_t i = 1; i < lengths.size(); ++i) {
    const ProcessResult longer = Gauntlet(Longer(dir, key + "=" + lengths[i], workers++));
    ASSERT_EQ(longer.exit_code, 0) << longer.err;
    EXPECT_EQ(Show(dir).at("finished"), true);
  }
  EXPECT_EQ(StateHash(dir), StateHash(whole));
  EXPECT_EQ(Content(dir), Content(whole));
  EXPECT_EQ(ReadFile(dir + "/experiment.toml"), ReadFile(whole + "/experiment.toml"));
}

INSTANTIATE_TEST_SUITE_P(Searches, ExtensionTest, testing::ValuesIn(Kinds()),
                         [](const auto& test) { return test.param.campaign.name; });

// Whatever moment the kill meets, the campaign has the old length or the new one, says which, and goes on.
TEST(ExtensionDrill, KillsAtAnyMomentLeaveTheOldLengthOrTheNew) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.population = 4;
  campaign.generations = 2;
  ASSERT_EQ(Gauntlet(EvolveArguments(campaign, scratch / "finished", 2)).exit_code, 0);
  campaign.generations = 6;
  sim::RandomStream random(17, sim::StreamPurpose::kTest);
  int extended = 0;
  constexpr int kKills = 8;
  for (int kill = 0; kill < kKills; ++kill) {
    const std::string dir = scratch / std::to_string(kill);
    std::filesystem::copy(scratch / "finished", dir, std::filesystem::copy_options::recursive);
    const std::string before = ReadFile(dir + "/experiment.toml");
    std::unique_ptr<Process> master = StartGauntlet(Longer(dir, "search.generations=6", 2));
    if (kill % 2 == 0) {
      EXPECT_TRUE(Eventually([&] { return ReadFile(dir + "/experiment.toml") != before; }, kPatience));
    } else {
      Eventually([&] { return !master->Running(); }, RandomTime(random, std::chrono::milliseconds(1000)));
    }
    master->Signal(SIGKILL);
    master->Wait();
    const nlohmann::json shown = Show(dir);
    const int generations = shown.at("generations").get<int>();
    EXPECT_EQ(generations, ReadFile(dir + "/experiment.toml") == before ? 2 : 6);
    extended += generations == 6 ? 1 : 0;
    if (shown.at("finished") == true) {
      EXPECT_EQ(shown.at("generation"), generations);
    }
    EXPECT_EQ(StatusOf(dir).at("state"), shown.at("finished") == true ? "finished" : "stopped");
    const ProcessResult last = Gauntlet(Longer(dir, "search.generations=6", 1));
    EXPECT_EQ(last.exit_code, 0) << last.err;
    EXPECT_EQ(StateHash(dir), UndisturbedHash(campaign));
  }
  fmt::print("killed {} times, {} of them after the length was changed\n", kKills, extended);
  EXPECT_GE(extended, kKills / 2);
}

// A finished campaign in which the longer search has not begun yet is not finished, whoever asks.
TEST(ExtensionDrill, BetweenExtensionAndEndEverybodyIsToldTheTruth) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  SmallCampaign campaign;
  campaign.generations = 2;
  ASSERT_EQ(Gauntlet(EvolveArguments(campaign, dir, 2)).exit_code, 0);
  const ProcessResult same = Gauntlet({"resume", dir, "--generations", "2"});
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_EQ(same.err, "gauntlet: " + (scratch / "c") +
                          " is that long already\n"
                          "gauntlet: " +
                          (scratch / "c") + " is finished, nothing was left to do\n");

  // No worker ever comes.
  std::unique_ptr<Process> master =
      StartGauntlet({"resume", dir, "--generations", "4", "--bind", "tcp://127.0.0.1:*"});
  ASSERT_TRUE(Serves(dir)) << master->Err();
  ASSERT_TRUE(StatusBecomes(dir, [](const auto& status) { return status.value("generations", 0) == 4; }));
  const nlohmann::json living = StatusOf(dir);
  EXPECT_EQ(living.at("state"), "running");
  EXPECT_EQ(living.at("runs_planned"), 32);
  EXPECT_EQ(Show(dir).at("finished"), false);
  const ProcessResult refused = Gauntlet({"resume", dir, "--generations", "6"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("in use by a living master"));
  master->Signal(SIGTERM);
  const ProcessResult stopped = master->Wait();
  EXPECT_EQ(stopped.exit_code, 3) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("search.generations from 2 to 4"));

  const nlohmann::json status = StatusOf(dir);
  EXPECT_EQ(status.at("state"), "stopped");
  EXPECT_EQ(status.at("generation"), 2);
  EXPECT_EQ(status.at("generations"), 4);
  EXPECT_EQ(status.at("why_nothing_runs").get<std::string>(),
            "no master serves the campaign: go on with `gauntlet resume DIR`");
  EXPECT_EQ(Show(dir).at("finished"), false);
  EXPECT_EQ(Gauntlet({"watch", dir}).out,
            (scratch / "c") +
                ": stopped\n"
                "generation 2/4, 16 runs done, 0 running, 0 waiting, 0.0/s\n"
                "nothing runs: no master serves the campaign: go on with `gauntlet resume " +
                (scratch / "c") + "`\n");
  EXPECT_THAT(Query(dir, "SELECT text FROM events WHERE kind = 'extended'"),
              testing::ElementsAre("search.generations from 2 to 4"));
  EXPECT_EQ(Gauntlet({"resume", dir, "--workers", "2"}).exit_code, 0);
  EXPECT_EQ(StatusOf(dir).at("state"), "finished");
  campaign.generations = 4;
  EXPECT_EQ(StateHash(dir), UndisturbedHash(campaign));
}

TEST(ExtensionRefusal, SaysWhyAndChangesNothing) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "genetic";
  SmallCampaign campaign;
  campaign.generations = 2;
  ASSERT_EQ(Gauntlet(EvolveArguments(campaign, dir, 2)).exit_code, 0);
  SmallCampaign random = WithLength(WithoutLength(SmallRandom()), "search.cases", "5");
  ASSERT_EQ(Gauntlet(EvolveArguments(random, scratch / "random", 2)).exit_code, 0);
  ASSERT_EQ(Gauntlet(EvolveArguments(SmallEvaluation(), scratch / "cases", 2)).exit_code, 0);
  const std::string experiment = ReadFile(dir + "/experiment.toml");
  struct Case {
    std::string dir;
    std::vector<std::string> options;
    std::string words;
  };
  const std::vector<Case> refused = {
      {"genetic", {"--generations", "1"}, "--generations 1: the campaign has search.generations = 2"},
      {"genetic", {"--generations", "0"}, "--generations 0: search.generations = 0 is out of range"},
      {"genetic", {"--generations", "many"}, "--generations many: "},
      {"genetic", {"--generations", "-3"}, "out of range"},
      {"genetic", {"--generations", "99999999999999999999"}, "--generations 99999999999999999999: "},
      {"genetic", {"--generations", "3", "--set", "search.generations=4"}, "give one of them"},
      {"genetic", {"--set", "search.population=10"}, "would no longer be the same search"},
      {"genetic", {"--set", "search.cases=10"}, "only its length may change, search.generations"},
      {"genetic", {"--set", "seed=8"}, "would no longer be the same search"},
      {"genetic", {"--set", "nonsense"}, "--set nonsense: "},
      {"genetic", {"--generations", "9", "--workers", "0"}, "--workers 0"},
      {"random", {"--generations", "9"}, "only its length may change, search.cases"},
      {"random", {"--set", "search.cases=4"}, "--set search.cases=4: the campaign has search.cases = 5"},
      {"cases",
       {"--generations", "9"},
       "--generations 9: this campaign ends with the last of its given cases"},
      {"cases", {"--set", "search.replicates=90"}, "ends with the last of its given cases"}};
  for (const auto& [name, options, words] : refused) {
    std::vector<std::string> arguments = {"resume", scratch / name};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProcessResult result = Gauntlet(arguments);
    EXPECT_EQ(result.exit_code, 2) << words;
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_EQ(result.out, "");
  }
  EXPECT_EQ(ReadFile(dir + "/experiment.toml"), experiment);
  EXPECT_EQ(Show(dir).at("finished"), true);
}

// A Slurm that takes every job and runs none.
class ExtensionOfASweep : public testing::Test {
 protected:
  ExtensionOfASweep() {
    std::filesystem::create_directories(scratch_ / "bin");
    for (const std::string name : {"sbatch", "squeue", "scancel"}) {
      std::ofstream(scratch_ / "bin/" + name) << "#!/bin/sh\n[ $(basename $0) != sbatch ] || echo 12\n";
      chmod((scratch_ / "bin/" + name).c_str(), 0755);
    }
  }
  // A campaign of several searches that has come to its end on this machine.
  void Submit(const std::string& dir, const std::vector<std::string>& sweep) const {
    std::vector<std::string> arguments = {"submit", "flocking", "--dir", dir, "--population", "4"};
    arguments.insert(arguments.end(), sweep.begin(), sweep.end());
    const ProcessResult submitted =
        RunProcess(GauntletCommand(arguments), {"PATH=" + scratch_ / "bin" + ":/usr/bin:/bin"});
    ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
    ASSERT_EQ(Gauntlet({"resume", dir, "--workers", "2"}).exit_code, 0);
  }

  TemporaryDirectory scratch_;
};

TEST_F(ExtensionOfASweep, IsThatOfAllItsSearches) {
  Submit(scratch_ / "whole", {"--seeds", "1..2", "--generations", "4"});
  Submit(scratch_ / "c", {"--seeds", "1..2", "--generations", "2"});
  const ProcessResult longer = Gauntlet(Longer(scratch_ / "c", "search.generations=4", 2));
  ASSERT_EQ(longer.exit_code, 0) << longer.err;
  const nlohmann::json shown = Show(scratch_ / "c");
  const nlohmann::json whole = Show(scratch_ / "whole");
  for (const int search : {0, 1}) {
    EXPECT_EQ(shown.at("searches").at(search).at("state_hash"),
              whole.at("searches").at(search).at("state_hash"));
  }
  EXPECT_EQ(shown.at("finished"), true);
  EXPECT_EQ(Content(scratch_ / "c"), Content(scratch_ / "whole"));
  for (const std::string file : {"/searches.json", "/experiment.toml"})
    EXPECT_EQ(ReadFile(scratch_ / "c" + file), ReadFile(scratch_ / "whole" + file)) << file;
}

TEST_F(ExtensionOfASweep, IsRefusedWhereTheLengthTellsItsSearchesApart) {
  Submit(scratch_ / "c", {"--sweep", "search.generations=1,2"});
  const std::string before = ReadFile(scratch_ / "c/searches.json");
  const ProcessResult refused = Gauntlet({"resume", scratch_ / "c", "--workers", "1", "--generations", "3"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err,
            "gauntlet: --generations 3: the searches of this campaign are told apart by search.generations "
            "(search.generations=1), so none can be made longer: begin a new campaign\n");
  EXPECT_EQ(ReadFile(scratch_ / "c/searches.json"), before);
}

}  // namespace
}  // namespace gauntlet::testing_support
