#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "master/study/study.h"

namespace gauntlet::master {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

// A study of one file, with `rest` behind its first part.
Result<Study> ReadWith(const std::string& rest, const std::string& beginning = "name = \"small\"\n") {
  return ReadStudy({{"small.toml", beginning +
                                       "[part.evolved]\nkind = \"evolve\"\nexperiment = \"flocking\"\n"
                                       "seeds = \"1..3\"\nset.search.generations = 4\n" +
                                       rest}},
                   "small.toml");
}

std::string ErrorWith(const std::string& rest, const std::string& beginning = "name = \"small\"\n") {
  const Result<Study> study = ReadWith(rest, beginning);
  return study ? "" : study.error().message;
}

std::string Evaluation(const std::string& keys) {
  return "[part.again]\nkind = \"evaluate\"\n" + keys;
}

TEST(StudyReader, PartsHaveTheSettingsOfThoseThatTheirCasesComeFromUnlessTheySayOtherwise) {
  const auto study =
      ReadWith(Evaluation("from = \"evolved:final\"\nset.controller = \"flocking-improved\"\n"));
  ASSERT_TRUE(study.ok()) << study.error().message;
  ASSERT_THAT(study->parts, SizeIs(2));
  EXPECT_EQ(study->parts[0].experiment.search.generations, 4);
  EXPECT_THAT(study->parts[0].seeds, ElementsAre(1, 2, 3));
  EXPECT_EQ(study->parts[1].from, "evolved");
  EXPECT_EQ(study->parts[1].subset, "final");
  EXPECT_EQ(study->parts[1].experiment.controller, "flocking-improved");
  EXPECT_EQ(study->parts[1].experiment.search.algorithm, "cases");
}

TEST(StudyReader, NamesWhatIsWrongAndWhere) {
  EXPECT_THAT(ErrorWith("kindd = 1\n"),
              HasSubstr("small.toml:7:1: unknown key 'kindd'; did you mean 'kind'?"));
  EXPECT_THAT(ErrorWith("[parts.x]\nkind = \"evolve\"\n"),
              HasSubstr("unknown key 'parts'; did you mean 'part'?"));
  EXPECT_THAT(ErrorWith(Evaluation("")), HasSubstr("a part of the kind evaluate needs the key from"));
  EXPECT_THAT(ErrorWith(Evaluation("from = \"evolvd\"\n")),
              HasSubstr("small.toml:9:1: unknown part 'evolvd'; did you mean 'evolved'?"));
  EXPECT_THAT(ErrorWith(Evaluation("from = \"again\"\n")), HasSubstr("unknown part 'again'"));
  EXPECT_THAT(ErrorWith(Evaluation("from = \"evolved:best\"\n")),
              HasSubstr("no subset 'best'; known: final"));
  EXPECT_THAT(
      ErrorWith(Evaluation("from = \"evolved\"\n") + "[part.third]\nkind = \"evaluate\"\nfrom = \"again\"\n"),
      HasSubstr("'again' simulates cases of 'evolved' itself; take them from there"));
  EXPECT_THAT(
      ErrorWith(Evaluation("from = \"evolved\"\nexperiment = \"foraging\"\n")),
      HasSubstr("part 'again' has the scenario 'foraging', the cases of 'evolved' are of 'flocking'"));
  EXPECT_THAT(ErrorWith("[part.r]\nkind = \"random\"\nexperiment = \"flocking\"\n"),
              HasSubstr("needs the key cases"));
  EXPECT_THAT(ErrorWith("[part.r]\nkind = \"randm\"\n"),
              HasSubstr("kind is 'randm', expected evolve, random"));
  EXPECT_THAT(ErrorWith("set.search.generatons = 3\n"), HasSubstr("did you mean 'search.generations'?"));
  EXPECT_THAT(ErrorWith("[compare.c]\ntitle = \"t\"\nfirst = \"evolved\"\n"),
              HasSubstr("[compare.c] needs the key second"));
  EXPECT_THAT(ErrorWith("[compare.c]\ntitle = \"t\"\nfirst = \"evolved\"\nsecond = \"evolve\"\n"),
              HasSubstr("second: unknown part 'evolve'; did you mean 'evolved'?"));
  const std::string sets = "title = \"t\"\nfirst = \"evolved\"\nsecond = \"evolved\"\n";
  EXPECT_THAT(ErrorWith("[compare.c]\n" + sets + "metric = \"birds_lft\"\n"),
              HasSubstr("did you mean 'birds_left'?"));
  EXPECT_THAT(ErrorWith("[compare.c]\n" + sets + "effect = \"big\"\n"),
              HasSubstr("effect is 'big', expected a number"));
  EXPECT_THAT(ErrorWith("[compare.c]\n" + sets + "expect = \"more\"\n"),
              HasSubstr("expected less or greater"));
  EXPECT_THAT(ErrorWith("", ""), HasSubstr("the study has no name"));
  EXPECT_THAT(ErrorWith("", "name = \"small\"\ninclude = \"small\"\n"),
              HasSubstr("small.toml is included twice"));
  EXPECT_THAT(LoadStudy("thesis-floking").error().message, HasSubstr("did you mean 'thesis-flocking'?"));
}

TEST(StudyReader, PublishedFiguresBelongToAnalysesAndTheirNotesExist) {
  const auto with = [](const std::string& row) {
    const auto study = ReadStudy(
        {{"s.toml",
          "name = \"s\"\npublished = \"p.csv\"\n[part.e]\nkind = \"evolve\"\nexperiment = \"flocking\"\n"
          "[note.why]\ntext = \"because\"\n[peak.p]\ntitle = \"t\"\npart = \"e\"\n"},
         {"p.csv", "section,quantity,condition,value,figure,rule,note\n" + row}},
        "s.toml");
    return study ? study->published.at(0).note.text : study.error().message;
  };
  EXPECT_EQ(with("1,a,b,2,p.generation,same,why\n"), "because");
  EXPECT_THAT(with("1,a,b,2,q.generation,same,why\n"), HasSubstr("unknown analysis 'q'"));
  EXPECT_THAT(with("1,a,b,2,p.generation,same,whi\n"), HasSubstr("there is no [note.whi]"));
}

TEST(StudyReader, EveryShippedStudyCanBeRead) {
  EXPECT_THAT(ShippedStudies(),
              ElementsAre("thesis", "thesis-flocking", "thesis-foraging", "thesis-partitioning"));
  for (const std::string& name : ShippedStudies()) {
    const auto study = LoadStudy(name);
    ASSERT_TRUE(study.ok()) << study.error().message;
    EXPECT_EQ(study->name, name);
    EXPECT_GT(study->published.size(), 50U);
    EXPECT_EQ(ReadStudy(study->texts, study->main_file)->parts.size(), study->parts.size());
  }
}

}  // namespace
}  // namespace gauntlet::master
