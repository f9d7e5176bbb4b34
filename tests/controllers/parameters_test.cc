// Every row of every table of parameters fills its settings.
#include "controllers/parameters.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <new>

#include "controllers/examples/light_flocking_registry.h"
#include "controllers/flocking/flocking_registry.h"
#include "controllers/foraging/foraging_registry.h"
#include "controllers/partitioning/partitioning_registry.h"
#include "controllers/registry.h"

namespace gauntlet::controllers {
namespace {

// The bytes of the settings, in memory that was zero before: equal settings have equal bytes.
template <typename Settings>
std::array<unsigned char, sizeof(Settings)> BytesOf(const ParameterTable<Settings>& table,
                                                    const sim::Parameters& given) {
  const auto resolved = ResolveParameters(table.infos(), given);
  EXPECT_TRUE(resolved.ok()) << resolved.error().message;
  alignas(Settings) std::array<unsigned char, sizeof(Settings)> bytes{};
  new (bytes.data()) Settings(table.Read(*resolved));
  static_assert(std::is_trivially_destructible_v<Settings>);
  return bytes;
}

template <typename Settings>
void ExpectEveryRowFills(const ParameterTable<Settings>& table) {
  const auto defaults = BytesOf(table, {});
  EXPECT_EQ(BytesOf(table, {}), defaults);
  for (const ParameterInfo& info : table.infos()) {
    const double other = info.default_value != info.min ? info.min : info.max;
    EXPECT_NE(BytesOf(table, {{std::string(info.name), other}}), defaults) << info.name;
  }
}

TEST(ParameterTables, EveryRowChangesTheSettings) {
  ExpectEveryRowFills(FlockingParameters());
  ExpectEveryRowFills(BirdParameters());
  ExpectEveryRowFills(ImprovedBirdParameters());
  ExpectEveryRowFills(ForagingParameters());
  ExpectEveryRowFills(BasicForagerParameters());
  ExpectEveryRowFills(ForagerParameters());
  ExpectEveryRowFills(RandomSideForagerParameters());
  ExpectEveryRowFills(ImprovedForagerParameters());
  ExpectEveryRowFills(PartitioningParameters());
  ExpectEveryRowFills(StaticPartitionerParameters());
  ExpectEveryRowFills(BugPartitionerParameters());
  ExpectEveryRowFills(DynamicPartitionerParameters());
  ExpectEveryRowFills(light_flocking::LightFlockingScenarioParameters());
  ExpectEveryRowFills(light_flocking::LightFlockingParameters());
}

struct Idle {
  double speed = 0.0;
};

// What the test above is worth.
TEST(ParameterTables, ARowThatFillsNothingShows) {
  const ParameterTable<Idle> table({{"speed", "m/s", 1, 0, 2, Fill<Idle>{[](Idle&, double) {}}, "lost"},
                                    {"gain", "", 1, 0, 2, Into<&Idle::speed>(), "taken for it"}});
  EXPECT_EQ(BytesOf(table, {{"speed", 0.0}}), BytesOf(table, {}));
  EXPECT_NE(BytesOf(table, {{"gain", 0.0}}), BytesOf(table, {}));
}

enum class Colour { kRed, kGreen };
struct Inner {
  double weight = 0.0;
};
struct Outer {
  int count = 0;
  bool flag = false;
  Colour colour = Colour::kRed;
  sim::Tick time = 0;
  std::optional<Inner> inner;
  double sum = 0.0;
};

const ParameterTable<Outer>& OuterParameters() {
  static const ParameterTable<Outer> table(
      {{"count", "", 3, 0, 9, Into<&Outer::count>(), "a count"},
       {"flag", "bool", 1, 0, 1, Into<&Outer::flag>(), "a flag"},
       {"colour", "", 1, 0, 1, Into<&Outer::colour>(), "a choice"},
       {"time", "s", 2.5, 0, 9, IntoTicks<&Outer::time>(), "a time"},
       {"sum", "", 0.5, 0, 9, Fill<Outer>{[](Outer& o, double value) { o.sum = o.count + value; }}, "more"}});
  return table;
}

TEST(ParameterTable, FillsMembersOfEveryType) {
  const Outer outer = OuterParameters().Read(*ResolveParameters(OuterParameters().infos(), {}));
  EXPECT_EQ(outer.count, 3);
  EXPECT_TRUE(outer.flag);
  EXPECT_EQ(outer.colour, Colour::kGreen);
  EXPECT_EQ(outer.time, 25);
  EXPECT_EQ(outer.sum, 3.5);
  EXPECT_FALSE(outer.inner);
}

TEST(ParameterTable, AsksForWholeNumbersWhereTheMemberIsOne) {
  std::vector<std::string_view> whole;
  for (const ParameterInfo& info : OuterParameters().infos()) {
    if (info.integer) whole.push_back(info.name);
  }
  EXPECT_EQ(whole, (std::vector<std::string_view>{"count", "flag", "colour"}));
}

TEST(ParameterTable, AppendsRowsAndEngagesOptionalMembers) {
  const ParameterTable<Outer> more(
      OuterParameters(), {{"weight", "m", 4, 0, 9, Into<&Outer::inner, &Inner::weight>(), "a weight"}});
  ASSERT_EQ(more.infos().size(), 6U);
  const Outer outer = more.Read(*ResolveParameters(more.infos(), {}));
  ASSERT_TRUE(outer.inner);
  EXPECT_EQ(outer.inner->weight, 4.0);
}

TEST(ParameterTable, KeepsWhatNoRowFills) {
  Outer start;
  start.inner = Inner{7.0};
  const ParameterTable<Outer> table = OuterParameters().StartingFrom(start);
  EXPECT_EQ(table.Read(*ResolveParameters(table.infos(), {})).inner->weight, 7.0);
}

TEST(ParameterTableDeathTest, NeedsResolvedParameters) {
  EXPECT_DEATH(OuterParameters().Read({}), "unresolved parameter count");
}

}  // namespace
}  // namespace gauntlet::controllers
