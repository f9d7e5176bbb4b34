// Covers: search/experiment/seed_list.cc, study/study_file.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "search/search_table.h"
#include "study/study.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
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
  EXPECT_EQ(ErrorWith("kindd = 1\n"), "small.toml:7:1: unknown key 'kindd'; did you mean 'kind'?");
  EXPECT_EQ(ErrorWith("[parts.x]\nkind = \"evolve\"\n"),
            "small.toml:8:1: unknown key 'parts'; did you mean 'part'?");
  EXPECT_EQ(ErrorWith(Evaluation("")), "small.toml:8:1: a part of the kind evaluate needs the key from");
  EXPECT_EQ(ErrorWith(Evaluation("from = \"evolvd\"\n")),
            "small.toml:9:1: unknown part 'evolvd'; did you mean 'evolved'? above this one");
  EXPECT_EQ(ErrorWith(Evaluation("from = \"again\"\n")),
            "small.toml:9:1: unknown part 'again'; known: evolved above this one");
  EXPECT_EQ(ErrorWith(Evaluation("from = \"evolved:best\"\n")),
            "small.toml:9:1: no subset 'best'; known: final, all, random:N, worst:N, and search:N in front "
            "of them");
  EXPECT_EQ(
      ErrorWith(Evaluation("from = \"evolved\"\n") + "[part.third]\nkind = \"evaluate\"\nfrom = \"again\"\n"),
      "small.toml:12:1: 'again' simulates cases of 'evolved' itself; take them from there");
  EXPECT_EQ(
      ErrorWith(Evaluation("from = \"evolved\"\nexperiment = \"foraging\"\n")),
      "small.toml:8:1: part 'again' has the scenario 'foraging', the cases of 'evolved' are of 'flocking'");
  EXPECT_EQ(ErrorWith("[part.r]\nkind = \"random\"\nexperiment = \"flocking\"\n"),
            "small.toml:8:1: a part of the kind random needs the key cases");
  EXPECT_EQ(ErrorWith("[part.r]\nkind = \"randm\"\n"),
            "small.toml:8:1: part.kind = \"randm\" is unknown, allowed evolve, random, empty, evaluate");
  EXPECT_EQ(ErrorWith("set.search.generatons = 3\n"),
            "small.toml:3:1: part 'evolved': --set search.generatons=3: unknown key 'search.generatons'; did "
            "you mean 'search.generations'?");
  EXPECT_EQ(ErrorWith("[compare.c]\ntitle = \"t\"\nfirst = \"evolved\"\n"),
            "small.toml:8:1: [compare.c] needs the key second");
  EXPECT_EQ(ErrorWith("[compare.c]\ntitle = \"t\"\nfirst = \"evolved\"\nsecond = \"evolve\"\n"),
            "small.toml:8:1: second: unknown part 'evolve'; did you mean 'evolved'?");
  const std::string sets = "title = \"t\"\nfirst = \"evolved\"\nsecond = \"evolved\"\n";
  EXPECT_EQ(ErrorWith("[compare.c]\n" + sets + "metric = \"birds_lft\"\n"),
            "small.toml:8:1: unknown metric 'birds_lft'; did you mean 'birds_left'?");
  EXPECT_EQ(ErrorWith("[compare.c]\n" + sets + "effect = \"big\"\n"),
            "small.toml:11:1: effect is text (\"big\"), expected a number");
  EXPECT_EQ(ErrorWith("[compare.c]\n" + sets + "expect = \"more\"\n"),
            "small.toml:11:1: expect = \"more\" is unknown, allowed less, greater");
  EXPECT_EQ(ErrorWith("", ""), "small.toml: the study has no name");
  EXPECT_EQ(
      ErrorWith("", "name = \"../../x\"\n"),
      "small.toml: name = \"../../x\" is no good folder name: use up to 64 letters, digits, '.', '_' or '-', "
      "and begin with none of '.' and '-'");
  EXPECT_EQ(ErrorWith("", "name = \"small\"\ninclude = \"small\"\n"), "small.toml is included twice");
  EXPECT_EQ(LoadStudy("thesis-floking").error().message,
            "unknown study 'thesis-floking'; did you mean 'thesis-flocking'? (a file is named by a path "
            "ending in .toml)");
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
  EXPECT_EQ(with("1,a,b,2,q.generation,same,why\n"),
            "published figure 'q.generation' (1): unknown analysis 'q'; known: p");
  EXPECT_EQ(with("1,a,b,2,p.generation,same,whi\n"),
            "p.csv: row 1 has the note 'whi', but there is no [note.whi]");
}

TEST(StudyReader, EveryShippedStudyCanBeRead) {
  EXPECT_THAT(ShippedStudies(),
              ElementsAre("beyond-aggregation", "beyond-coverage", "beyond-site-selection", "beyond-thesis",
                          "thesis", "thesis-flocking", "thesis-flocking-core", "thesis-foraging",
                          "thesis-partitioning", "tune-flocking", "tune-foraging"));
  for (const std::string& name : ShippedStudies()) {
    const auto study = LoadStudy(name);
    ASSERT_TRUE(study.ok()) << study.error().message;
    EXPECT_EQ(study->name, name);
    if (name != "thesis-flocking-core" && !name.starts_with("beyond-"))
      EXPECT_GE(study->published.size(), 8U);  // its rows are thesis-flocking's
    EXPECT_EQ(ReadStudy(study->texts, study->main_file)->parts.size(), study->parts.size());
  }
}

constexpr const char* kTuning =
    "name = \"t\"\n[tune.flock]\ntitle = \"t\"\nexperiment = \"flocking\"\nrepeats = 3\n"
    "set.genome.genes = 4\n"
    "candidates.search.population = \"10, 20, 30\"\ncandidates.genome.genes = \"6\"\n";

Result<Study> ReadTuning(const std::string& rest, const TuningChanges& changes = {}) {
  return ReadStudy({{"t.toml", kTuning + rest}}, "t.toml", changes);
}

std::string TuningError(const std::string& rest, const TuningChanges& changes = {}) {
  const Result<Study> study = ReadTuning(rest, changes);
  return study ? "" : study.error().message;
}

TEST(StudyReader, ATuningIsABaselineAndAPartForEveryOtherValueWithSeedsOfItsOwn) {
  const auto study = ReadTuning("");
  ASSERT_TRUE(study.ok()) << study.error().message;
  std::vector<std::string> names;
  std::set<std::uint64_t> seeds;
  for (const StudyPart& part : study->parts) {
    names.push_back(part.name);
    seeds.insert(part.seeds.begin(), part.seeds.end());
  }
  EXPECT_THAT(names, ElementsAre("flock.baseline", "flock.baseline-again", "flock.search.population=10",
                                 "flock.search.population=10-again", "flock.search.population=30",
                                 "flock.search.population=30-again", "flock.genome.genes=6",
                                 "flock.genome.genes=6-again"));
  EXPECT_EQ(seeds.size(), 4U * 3U + 4U);
  EXPECT_EQ(study->parts[0].experiment.genome.genes, 4);
  EXPECT_EQ(study->parts[2].experiment.search.population, 10);
  EXPECT_EQ(study->parts[2].experiment.genome.genes, 4);
  EXPECT_EQ(study->parts[3].from, "flock.search.population=10");
  EXPECT_EQ(study->parts[6].experiment.search.population, 20);
  EXPECT_EQ(study->parts[7].experiment.search.algorithm, "cases");
  ASSERT_TRUE(study->analyses.front().tuning.has_value());
  const Tuning& tuning = *study->analyses.front().tuning;
  EXPECT_EQ(tuning.repeats, 3);
  ASSERT_THAT(tuning.parameters, SizeIs(2));
  EXPECT_EQ(tuning.parameters[0].key, "search.population");
  EXPECT_EQ(tuning.parameters[0].values[1].part, "flock.baseline");
  EXPECT_THAT(tuning.parameters[1].values, SizeIs(2)) << "the baseline's value is added";
  EXPECT_EQ(tuning.parameters[1].values[0].value, "4");
}

TEST(StudyReader, ATuningTakesAnotherExperimentRepeatsAndSettings) {
  const auto study =
      ReadTuning("", {.experiment = "foraging", .repeats = "2", .sets = {"search.population=30"}});
  ASSERT_TRUE(study.ok()) << study.error().message;
  EXPECT_EQ(study->name, "tune-foraging");
  EXPECT_THAT(study->parts.front().seeds, SizeIs(2));
  EXPECT_EQ(study->parts.front().experiment.scenario, "foraging");
  EXPECT_EQ(study->analyses.front().tuning->parameters.front().baseline, "30");
}

TEST(StudyReader, ATuningIsCalledAsItsFileSaysUnlessItIsOfAnotherExperiment) {
  const auto own = ReadTuning("", {.experiment = "flocking", .repeats = "2"});
  ASSERT_TRUE(own.ok()) << own.error().message;
  EXPECT_EQ(own->name, "t");
  EXPECT_EQ(own->description, "which values of the search's parameters find tougher cases for flocking");
  EXPECT_EQ(ReadTuning("", {.experiment = "foraging", .repeats = "2"})->name, "tune-foraging");
}

TEST(StudyReader, ATuningTriesTheValuesThatWereTyped) {
  const auto study = ReadTuning("", {.tries = {"search.population=10,40"}});
  ASSERT_TRUE(study.ok()) << study.error().message;
  EXPECT_THAT(study->parts, SizeIs(6));
  const Tuning& tuning = *study->analyses.front().tuning;
  ASSERT_THAT(tuning.parameters, SizeIs(1));
  EXPECT_THAT(tuning.parameters[0].values,
              ElementsAre(Field(&TunedValue::value, "20"), Field(&TunedValue::value, "10"),
                          Field(&TunedValue::value, "40")));
  EXPECT_EQ(tuning.title, "Parameters of the search");
  EXPECT_EQ(TuningError("", {.tries = {"search.population"}}),
            "--try search.population: give a key and the values to try, key=a,b,c");
  EXPECT_EQ(TuningError("", {.tries = {"=1"}}), "--try =1: give a key and the values to try, key=a,b,c");
  EXPECT_EQ(TuningError("", {.tries = {"genome.genes=1", "genome.genes=2"}}),
            "--try genome.genes=2: genome.genes is tried already; give all its values at once");
  EXPECT_EQ(
      TuningError("", {.tries = {"search.popluation=10"}}),
      "--try search.popluation=10: --set search.popluation=10: unknown key 'search.popluation'; did you "
      "mean 'search.population'?");
}

TEST(StudyReader, ABudgetOfATuningSetsTheGenerationsOfEachValue) {
  const auto study = ReadTuning("", {.tries = {"search.population=10,40"}, .budget = "200"});
  ASSERT_TRUE(study.ok()) << study.error().message;
  for (const auto& [part, population] : {std::pair(0, 20), {2, 10}, {4, 40}}) {
    const Experiment& experiment = study->parts[part].experiment;
    EXPECT_EQ(experiment.search.population, population);
    const auto search = MakeSearch(experiment);
    EXPECT_EQ((*search)->Progress().evaluations_planned, 200U) << population;
  }
  EXPECT_EQ(ReadTuning("", {.tries = {"search.population=10"}, .budget = "219"})
                ->parts[0]
                .experiment.search.generations,
            ReadTuning("", {.tries = {"search.population=10"}, .budget = "200"})
                ->parts[0]
                .experiment.search.generations);
  EXPECT_EQ(TuningError("", {.tries = {"search.population=10,40"}, .budget = "39"}),
            "--try search.population=10,40: --budget 39 does not pay for the first generation, which takes "
            "40 runs");
  EXPECT_EQ(TuningError("", {.tries = {"search.generations=10,40"}, .budget = "100"}),
            "--try search.generations=10,40: with --budget the number of generations follows from the runs");
  for (const char* bad : {"0", "-1", "1e3", "1000000001"}) {
    EXPECT_EQ(TuningError("", {.budget = bad}),
              std::string("--budget ") + bad +
                  ": give the runs of each evolution, a whole number from 1 to 1000000000");
  }
}

TEST(StudyReader, SaysWhatIsWrongWithATuning) {
  EXPECT_EQ(TuningError("candidates.search.crossover = \"singlepoint\"\n"),
            "t.toml:9:19: --set search.crossover=singlepoint: search.crossover = \"singlepoint\" is unknown, "
            "allowed single-point, double-point, uniform");
  EXPECT_EQ(TuningError("candidates.search.popluation = \"4\"\n"),
            "t.toml:9:19: --set search.popluation=4: unknown key 'search.popluation'; did you mean "
            "'search.population'?");
  EXPECT_EQ(TuningError("candidates.search.cases = \"4\"\n"),
            "t.toml:9:19: the search 'genetic' does not read search.cases");
  EXPECT_EQ(TuningError("candidates.search.crossover = \"uniform, uniform\"\n"),
            "t.toml:9:19: uniform is given twice");
  EXPECT_EQ(TuningError("candidates.search.crossover = \"single-point\"\n"),
            "t.toml:9:19: search.crossover has no candidate besides its baseline value single-point");
  EXPECT_EQ(TuningError("candidates.seed = \"4\"\n"), "t.toml:9:12: seed is no parameter of a search");
  EXPECT_EQ(TuningError("sizes = \"5, 1\"\n"),
            "t.toml:9:1: sizes are '5, 1', expected ascending whole numbers from 1 to 10000");
  EXPECT_EQ(TuningError("set.search.algorithm = \"random\"\n"),
            "flocking: search.algorithm = \"random\" has no population: tuning is for genetic and "
            "steady-state searches");
  EXPECT_EQ(TuningError("", {.repeats = "101"}), "--repeats 101: give a whole number from 1 to 100");
  EXPECT_EQ(TuningError("", {.sets = {"search.generations=0"}}),
            "--set search.generations=0: search.generations = 0 is out of range, allowed 1 to 1000000");
}

TEST(StudyReader, TheShippedTuningsHoldTheCandidatesOfTheThesis) {
  for (const auto& [name, generations] :
       {std::pair("tune-flocking", "50"), std::pair("tune-foraging", "30")}) {
    const auto study = LoadStudy(name);
    ASSERT_TRUE(study.ok()) << study.error().message;
    const Tuning& tuning = *study->analyses.front().tuning;
    EXPECT_EQ(tuning.repeats, 20);
    std::map<std::string, std::size_t> candidates;
    for (const TunedParameter& parameter : tuning.parameters)
      candidates[parameter.key] = parameter.values.size();
    const std::map<std::string, std::size_t> expected = {{"genome.genes", 4},
                                                         {"search.population", 5},
                                                         {"search.parent_selection", 3},
                                                         {"search.crossover", 3},
                                                         {"search.crossover_probability", 3},
                                                         {"search.mutation_probability", 4},
                                                         {"search.generations", 4}};
    EXPECT_EQ(candidates, expected) << "and none besides for the baseline";
    EXPECT_EQ(tuning.parameters.back().baseline, generations);
    EXPECT_THAT(study->published, SizeIs(8));
  }
}

}  // namespace
}  // namespace gauntlet
