#include "search/cases/corpus_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "search/cases/case_file.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing_support::TemporaryDirectory;

CorpusCase Sample(const std::string& name) {
  CorpusCase one;
  one.name = name;
  one.found_in = "run 812 of flocking";
  one.found = {5, 6, {0.44, 0.97}};
  one.settings = {{"scenario", "flocking"},
                  {"controller", "flocking"},
                  {"controller_parameters.bird_speed", "0.055"},
                  {"faults", "3:wheels@500"}};
  one.document.test_case.name = "run 812";
  one.document.test_case.obstacles = {
      {.x = 0.5, .y = -1.0, .length = 1.6, .width = 0.2, .orientation_deg = 45}};
  return one;
}

std::string Replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

std::string CorpusError(const std::string& text) {
  const Result<CorpusCase> one = ParseCorpusCase(text, "a.json");
  EXPECT_FALSE(one.ok());
  return one ? "" : one.error().message;
}

TEST(CorpusFileTest, ACaseSurvivesTheRoundTrip) {
  const CorpusCase one = Sample("run-812");
  const std::string text = WriteCorpusCase(one);
  const Result<CorpusCase> read = ParseCorpusCase(text, "a.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->document.test_case.obstacles, one.document.test_case.obstacles);
  EXPECT_EQ(SettingOf(*read, "controller_parameters.bird_speed"), "0.055");
  EXPECT_EQ(SettingOf(*read, "faults"), "3:wheels@500");
  EXPECT_EQ(SettingOf(*read, "physics"), "");
  EXPECT_EQ(read->found.failures, 5);
  EXPECT_EQ(read->expected, "fail");
}

TEST(CorpusFileTest, IsACaseFileToo) {
  const TemporaryDirectory scratch;
  const CorpusCase one = Sample("run-812");
  std::ofstream(scratch / "run-812.json") << WriteCorpusCase(one);
  const Result<LoadedCase> loaded = LoadCase(scratch / "run-812.json");
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  EXPECT_EQ(loaded->test_case.obstacles, one.document.test_case.obstacles);
}

TEST(CorpusFileTest, SaysWhatIsWrong) {
  const std::string good = WriteCorpusCase(Sample("run-812"));
  EXPECT_EQ(CorpusError("{}"),
            "a.json: no case of a corpus: it has no whole number \"format\". `gauntlet corpus add` makes one "
            "of a case");
  EXPECT_EQ(CorpusError(Replaced(good, "\"format\": 1", "\"format\": 2")),
            "a.json: format = 2 is that of a newer version of gauntlet; this version reads format 1");
  EXPECT_EQ(CorpusError(Replaced(good, "\"expected\": \"fail\"", "\"expected\": \"passes\"")),
            "a.json: expected = 'passes': one of fail, flaky, pass is needed");
  EXPECT_EQ(CorpusError(Replaced(good, "\"expected\":", "\"expcted\":")),
            "a.json: unknown key 'expcted'; did you mean 'expected'?");
  EXPECT_EQ(CorpusError(Replaced(good, "\"scenario\":", "\"scenarios\":")),
            "a.json: experiment.scenario is missing");
  EXPECT_EQ(CorpusError(Replaced(good, "\"length\":", "\"lenght\":")),
            "a.json: case: obstacles[0]: unknown key 'lenght'; did you mean 'length'?");
  EXPECT_EQ(CorpusError(Replaced(good, "\"k\": 5", "\"k\": 7")),
            "a.json: 'found' needs k failures of n runs, {\"k\": 5, \"n\": 5, ...}");
  EXPECT_EQ(CorpusError(Replaced(good, "\"run-812\"", "\"../x\"")),
            "a.json: name = '../x': a text that can name a file is needed");
  EXPECT_EQ(CorpusError(Replaced(good, "\"run-812\"", "\"a\\nb\"")),
            "a.json: name = 'a\\nb': a text that can name a file is needed");
  EXPECT_EQ(CorpusError(Replaced(good, "\"run 812 of flocking\"", "812")), "a.json: found_in is no text");
  EXPECT_EQ(CorpusError(Replaced(good, "0.44", "0.94")),
            "a.json: found.interval = [0.94, 0.97]: of a probability, with 5 of 6 within it, is needed");
  EXPECT_EQ(
      CorpusError(Replaced(good, "0.055", "\"0.055\"")),
      "a.json: experiment.controller_parameters.bird_speed = \"0.055\": a number stands without quotes");
  EXPECT_EQ(CorpusError("{\"format\": 1"), "a.json:1:13: unexpected end of input; expected '}'");
}

class CorpusTest : public testing::Test {
 protected:
  void Write(const std::string& file, const std::string& text) const {
    std::ofstream(scratch_ / file) << text;
  }
  std::string Error() const {
    const Result<std::vector<CorpusEntry>> corpus = ReadCorpus(scratch_.path());
    EXPECT_FALSE(corpus.ok());
    return corpus ? "" : corpus.error().message;
  }
  const TemporaryDirectory scratch_;
};

TEST_F(CorpusTest, IsReadByTheNamesOfItsFiles) {
  Write("b.json", WriteCorpusCase(Sample("first")));
  Write("a.json", WriteCorpusCase(Sample("second")));
  Write("a.svg", "<svg/>");
  const Result<std::vector<CorpusEntry>> corpus = ReadCorpus(scratch_.path());
  ASSERT_TRUE(corpus.ok()) << corpus.error().message;
  ASSERT_EQ(corpus->size(), 2U);
  EXPECT_EQ(corpus->front().content.name, "second");
}

TEST_F(CorpusTest, SaysWhatIsWrongWithItAsAWhole) {
  EXPECT_EQ(Error(), scratch_.path() + " holds no case: `gauntlet corpus add DIR RUN_ID --to " +
                         scratch_.path() + "` adds one");
  Write("a.json", WriteCorpusCase(Sample("jam")));
  Write("b.json", WriteCorpusCase(Sample("jam")));
  EXPECT_EQ(Error(), scratch_.path() + "/a.json and " + scratch_.path() +
                         "/b.json are both called 'jam': give one of them another name");
  CorpusCase other = Sample("queue");
  other.settings[0].second = "foraging";
  Write("b.json", WriteCorpusCase(other));
  EXPECT_EQ(Error(), scratch_.path() + "/a.json is of the scenario 'flocking', " + scratch_.path() +
                         "/b.json of 'foraging': a corpus holds cases of one scenario");
  EXPECT_EQ(ReadCorpus(scratch_ / "none").error().message,
            scratch_.path() + "/none: no such folder; `gauntlet corpus add DIR RUN_ID --to " +
                scratch_.path() + "/none` makes it");
}

}  // namespace
}  // namespace gauntlet
