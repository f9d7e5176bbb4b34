// What can be written, and what is said of what cannot.
#include "controllers/requirements/formula_reader.h"

#include <gmock/gmock.h>

namespace gauntlet::controllers::requirements {
namespace {

using testing::HasSubstr;

const std::vector<MetricInfo> kMetrics = {{"arrival_time", "s", kNotMeasured, ""}, {"order", "", {}, ""}};

class FormulaReaderTest : public testing::Test {
 protected:
  Result<std::size_t> Read(const std::string& text) {
    return FormulaReader(kMetrics, sentences_, nodes_).Read(text);
  }
  // "" when there is nothing wrong.
  std::string Wrong(const std::string& text) {
    const auto read = Read(text);
    return read ? "" : read.error().message;
  }

  std::vector<Sentence> sentences_;
  std::vector<Node> nodes_;
};

TEST_F(FormulaReaderTest, BindsAsItSays) {
  const std::size_t either = Read("not time < 1 and time < 2 or time < 3 implies time < 4").value();
  // (not (not 1 and 2 or 3)) or 4
  const Node& implication = nodes_[either];
  EXPECT_EQ(implication.operation, Operation::kOr);
  EXPECT_EQ(nodes_[implication.left].operation, Operation::kNot);
  const Node& disjunction = nodes_[nodes_[implication.left].left];
  EXPECT_EQ(disjunction.operation, Operation::kOr);
  const Node& conjunction = nodes_[disjunction.left];
  EXPECT_EQ(conjunction.operation, Operation::kAnd);
  EXPECT_EQ(nodes_[conjunction.left].operation, Operation::kNot);
  EXPECT_EQ(nodes_[conjunction.right].text, "time < 2");
}

TEST_F(FormulaReaderTest, AWindowIsOfWhatFollowsIt) {
  const Node& node =
      nodes_[Read("eventually[0, 120] always[0.5,30] speed + 1 * 2 >= 8 and time > 0").value()];
  EXPECT_EQ(node.operation, Operation::kAnd);
  const Node& eventually = nodes_[node.left];
  EXPECT_EQ(eventually.operation, Operation::kEventually);
  EXPECT_EQ(eventually.window.end, 120.0);
  EXPECT_EQ(nodes_[eventually.left].window.begin, 0.5);
  EXPECT_EQ(nodes_[nodes_[eventually.left].left].text, "speed + 1 * 2 >= 8");
}

TEST_F(FormulaReaderTest, ANameIsASentenceThenAMeasureThenAMetric) {
  sentences_ = {{"near", "", Read("count(distance_to(-1.5, 2e-1) < 1)").value()}};
  EXPECT_EQ(nodes_[nodes_[Read("near >= 8").value()].left].operation, Operation::kCount);
  EXPECT_EQ(nodes_[nodes_[Read("order > 0").value()].left].operation, Operation::kMeasure);
  EXPECT_EQ(nodes_[nodes_[Read("arrival_time > 0").value()].left].operation, Operation::kMetric);
  const Node& distance = nodes_[nodes_[nodes_[sentences_[0].node].left].left];
  EXPECT_EQ(distance.point, sim::Vec2(-1.5, 0.2));
  EXPECT_TRUE(distance.per_robot);
}

TEST_F(FormulaReaderTest, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(Wrong(""), "the formula is empty");
  EXPECT_EQ(Wrong("tim > 1"), "character 1: unknown measure 'tim'; did you mean 'time'?");
  EXPECT_EQ(Wrong("arrival_tim > 1"),
            "character 1: unknown measure 'arrival_tim'; did you mean 'arrival_time'?");
  EXPECT_EQ(Wrong("time >"), "character 7: it ends too early: a value or a bracket is missing");
  EXPECT_EQ(Wrong("(time > 1"), "character 10: it ends too early: ')' is missing");
  EXPECT_EQ(Wrong("time > 1)"), "character 9: ')' cannot stand here");
  EXPECT_EQ(Wrong("time > 1 time"), "character 10: 'time' cannot stand here");
  EXPECT_EQ(Wrong("time # 1"), "character 6: nothing that a formula consists of");
  EXPECT_EQ(Wrong("always[-1,2] time > 1"),
            "character 8: a window lies in the future: its seconds count from 0 on");
  EXPECT_EQ(Wrong("always[3,2] time > 1"), "character 11: the window [3,2] ends before it begins");
  EXPECT_EQ(Wrong("always[0;2] time > 1"), "character 9: nothing that a formula consists of");
  EXPECT_EQ(Wrong("always time"),
            "character 12: 'always' is of something that holds or does not, not of a "
            "number: compare it");
  EXPECT_THAT(Wrong("(time > 1) + 2 > 3"), HasSubstr("'+' is of a number"));
  EXPECT_THAT(Wrong("time and order > 0"), HasSubstr("compare it"));
  EXPECT_EQ(Wrong("time / 0 > 1"), "character 10: it divides by 0");
  EXPECT_THAT(Wrong("1 / time > 1"), HasSubstr("'time' is no number from 0 to 1e+09"));
  EXPECT_THAT(Wrong("time > 1e400"), HasSubstr("is no number from 0 to"));
  EXPECT_THAT(Wrong("x > 1"), HasSubstr("'x' is of each robot: write count(... x ...)"));
  EXPECT_THAT(Wrong("count(time > 1) > 1"), HasSubstr("is the same for all robots"));
  EXPECT_THAT(Wrong("count(x) > 1"), HasSubstr("compare it"));
  EXPECT_THAT(Wrong("count(count(x > 1) > 2) > 1"), HasSubstr("'count' stands within another one"));
  EXPECT_THAT(Wrong("count(always x > 1) > 1"), HasSubstr("'always' is of the swarm, not of each robot"));
  EXPECT_THAT(Wrong("distance_to(gaol) < 1"),
              HasSubstr("a distance is to (goal), (start), (center) or (X, Y)"));
  EXPECT_THAT(Wrong("max(time) > 1"), HasSubstr("'max' is of two values or more"));
  EXPECT_THAT(Wrong(std::string(3000, ' ')), HasSubstr("a formula of 3000 characters; it may have 2000"));
}

TEST_F(FormulaReaderTest, RefusesWhatIsTooDeep) {
  for (const char* word : {"(", "not ", "always ", "-", "max(1,"}) {
    std::string deep;
    for (int i = 0; i < 1000 && deep.size() + 20 < kMostCharacters; ++i) deep += word;
    EXPECT_THAT(Wrong(deep + "time > 1"), HasSubstr("it is nested deeper than 100")) << word;
  }
  std::string implies = "1 > 0";
  for (int i = 0; i < 150; ++i) implies += " implies 1>0";
  EXPECT_THAT(Wrong(implies), HasSubstr("it is nested deeper than 100"));
}

}  // namespace
}  // namespace gauntlet::controllers::requirements
