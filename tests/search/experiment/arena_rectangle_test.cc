// Covers: search/experiment/genome_ranges.cc, search/experiment/schema.cc
// The arena of a program is a rectangle anywhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::string_view kProgram = "scenario = 'command'\n[arena]\nwall_thickness = 0.01\n";

// With a scenario of the name that programs have.
Catalogue CommandCatalogue() {
  static const std::array scenarios = std::to_array<controllers::ScenarioInfo>({
      {.name = "command",
       .description = "runs a program",
       .default_controller = "program",
       .time_limit = "",
       .metrics = {},
       .requirements = nullptr,
       .create = nullptr},
      {.name = "marching",
       .description = "walk",
       .default_controller = "walker",
       .time_limit = "",
       .metrics = {},
       .requirements = nullptr,
       .create = nullptr},
  });
  static const std::array controllers_of_both = std::to_array<controllers::ControllerInfo>({
      {"program", "command", "its parameters", {}, nullptr},
      {"walker", "marching", "walks", {}, nullptr},
  });
  return {scenarios, controllers_of_both, BuiltInCatalogue().searches};
}

Result<Experiment> ReadProgram(std::string_view text, const std::vector<std::string>& sets = {}) {
  return ParseExperiment(text, "program.toml", sets, CommandCatalogue());
}

std::string Refusal(std::string_view text, const std::vector<std::string>& sets) {
  const Result<Experiment> experiment = ReadProgram(text, sets);
  return experiment.ok() ? "" : experiment.error().message;
}

TEST(ArenaRectangleTest, IsTheArenaAndWhereObstaclesStand) {
  const Result<Experiment> experiment =
      ReadProgram(kProgram, {"arena.x_min=0.2", "arena.x_max=0.3", "arena.y_min=-3", "arena.y_max=1"});
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  const sim::TestCase arena = EmptyArena(experiment->arena);
  EXPECT_EQ(arena.side_x, 0.1);  // decimals stay decimals
  EXPECT_EQ(arena.side_y, 4.0);
  EXPECT_EQ(arena.center, sim::Vec2(0.25, -1.0));
  const sim::Rectangle places = GenomeOf(*experiment).Places();
  EXPECT_EQ(places.min, sim::Vec2(0.2, -3.0));
  EXPECT_EQ(places.max, sim::Vec2(0.3, 1.0));
}

TEST(ArenaRectangleTest, IsWrittenInsteadOfWhatItSays) {
  const Result<Experiment> experiment =
      ReadProgram(kProgram, {"arena.x_max=2", "arena.y_max=1", "genome.position_min=-1", "arena.side=9"});
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  const std::string text = WriteExperiment(*experiment, {}, CommandCatalogue());
  EXPECT_THAT(text, HasSubstr("\nx_max = 2.0 "));
  EXPECT_THAT(text, HasSubstr("\ny_max = 1.0 "));
  for (const char* key : {"\nside =", "position_min", "position_max"}) EXPECT_THAT(text, Not(HasSubstr(key)));
  const Result<Experiment> read = ReadProgram(text);
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(WriteExperiment(*read, {}, CommandCatalogue()), text);
  EXPECT_EQ(read->genome.position_min, experiment->genome.position_min);

  const std::string square = WriteExperiment(*ReadProgram(kProgram), {}, CommandCatalogue());
  for (const char* key : {"x_min", "x_max", "y_min", "y_max"}) EXPECT_THAT(square, Not(HasSubstr(key)));
  EXPECT_THAT(square, HasSubstr("\nside = 6.0 "));
}

TEST(ArenaRectangleTest, ChangesTheIdentityOfASearchOnlyWhereItIsGiven) {
  const Experiment square = *ReadProgram(kProgram);
  const Experiment rectangle = *ReadProgram(kProgram, {"arena.x_max=2", "arena.y_max=1"});
  EXPECT_THAT(SearchIdentity(SetupOf(square)), Not(HasSubstr("arena.x_m")));
  EXPECT_THAT(SearchIdentity(SetupOf(rectangle)), HasSubstr("arena.x_max = 2.0\n"));
}

TEST(ArenaRectangleTest, OthersThanProgramsHaveSquares) {
  EXPECT_EQ(
      Refusal("scenario = 'marching'", {"arena.y_max=1"}),
      "--set arena.y_max=1: arena.y_max = 1.0: arenas of this engine are squares around the origin: set "
      "arena.side");
}

TEST(ArenaRectangleTest, HasRightSidesWallsAndGrid) {
  EXPECT_EQ(
      Refusal(kProgram, {"arena.x_max=2"}),
      "program.toml: arena.y_min = 0 to arena.y_max = 0: want 0.1 to 100 m between them (a rectangle has "
      "x_min, x_max, y_min and y_max)");
  EXPECT_EQ(Refusal(kProgram, {"arena.x_min=5", "arena.x_max=2", "arena.y_max=1"}),
            "--set arena.x_max=2: arena.x_min = 5 to arena.x_max = 2: want 0.1 to 100 m between them (a "
            "rectangle has x_min, x_max, y_min and y_max)");
  EXPECT_THAT(Refusal(kProgram, {"arena.x_max=101", "arena.y_max=1"}), HasSubstr("want 0.1 to 100 m"));
  EXPECT_EQ(Refusal(kProgram, {"arena.x_max=0.1", "arena.y_max=2", "arena.wall_thickness=0.1"}),
            "--set arena.wall_thickness=0.1: arena.wall_thickness = 0.1 must not exceed half of the arena's "
            "shorter side = 0.1");
  EXPECT_EQ(
      Refusal(kProgram, {"arena.x_min=0.11", "arena.x_max=0.29", "arena.y_max=1", "genome.step=0.5"}),
      "--set arena.x_min=0.11: arena.x_min = 0.11 to arena.x_max = 0.29 holds no multiple of genome.step "
      "= 0.5");
}

}  // namespace
}  // namespace gauntlet
