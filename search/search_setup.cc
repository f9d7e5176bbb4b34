#include "search/search_setup.h"

#include <span>

#include <fmt/format.h>

#include "base/check.h"
#include "base/hash.h"
#include "search/experiment/disturbance_keys.h"
#include "search/search_row.h"
#include "sim/arena/genome.h"

namespace gauntlet {
namespace {

void AddCase(const sim::TestCase& test_case, Fnv1a64& hash) {
  hash.AddUint64(GenomeHash(test_case.obstacles));
  hash.AddDouble(test_case.side_x);
  hash.AddDouble(test_case.side_y);
  hash.AddDouble(test_case.wall_thickness);
  hash.AddUint64(static_cast<std::uint64_t>(test_case.robots.value_or(-1)));
  for (const sim::Pose& pose : test_case.start_poses) {
    hash.AddDouble(pose.position.x());
    hash.AddDouble(pose.position.y());
    hash.AddDouble(pose.heading);
  }
  if (test_case.center != sim::Vec2::Zero()) {
    hash.AddDouble(test_case.center.x());
    hash.AddDouble(test_case.center.y());
  }
  if (!test_case.spawn_area.has_value()) return;
  for (const sim::Vec2& corner : {test_case.spawn_area->min, test_case.spawn_area->max}) {
    hash.AddDouble(corner.x());
    hash.AddDouble(corner.y());
  }
}

std::uint64_t HashOf(std::span<const sim::TestCase> cases) {
  Fnv1a64 hash;
  for (const sim::TestCase& test_case : cases) AddCase(test_case, hash);
  return hash.value();
}

}  // namespace

std::uint64_t CaseHash(const sim::TestCase& test_case) {
  return HashOf({&test_case, 1});
}

sim::TestCase EmptyArena(const ArenaSpec& arena) {
  sim::TestCase test_case;
  const sim::Vec2 sides = arena.Sides();
  test_case.side_x = sides.x();
  test_case.side_y = sides.y();
  test_case.center = arena.Center();
  test_case.wall_thickness = arena.wall_thickness;
  return test_case;
}

GenomeGenerator MakeGenerator(const SearchSetup& setup) {
  return {GenomeOf(setup.experiment), EmptyArena(setup.experiment.arena), setup.requirements};
}

std::uint64_t SearchSeed(const SearchSetup& setup) {
  return sim::DeriveSeed(setup.experiment.seed, sim::SeedPurpose::kSearch, kSearchNumber,
                         /*individual=*/0, /*evaluation=*/0, setup.row->number);
}

sim::RandomStream GenomeStream(std::uint64_t search_seed, std::uint64_t id) {
  GAUNTLET_CHECK(id <= 0xFFFFFFFFULL, fmt::format("individual {}", id));
  return {search_seed, sim::StreamPurpose::kGenome, static_cast<std::uint32_t>(id)};
}

std::string SearchIdentity(const SearchSetup& setup) {
  const Experiment& experiment = setup.experiment;
  const SearchInfo& search = setup.row->info;
  const auto matters = [&](const Key& key) {
    if (key.for_people || key.path == search.length) return false;
    if (key.of_searches && !Reads(search, key.path)) return false;
    if (NobodyIsDrawn(experiment, key.path)) return false;
    return !key.came_later || key.get(experiment) != key.default_value;
  };
  std::string identity = fmt::format("search = {}\n", kSearchNumber);
  for (const Key& key : setup.keys) {
    if (matters(key)) identity += fmt::format("{} = {}\n", key.path, ToToml(key.get(experiment)));
  }
  const auto add = [&](std::string_view table, const sim::Parameters& parameters) {
    for (const auto& [name, value] : parameters) identity += fmt::format("{}.{} = {}\n", table, name, value);
  };
  if (!experiment.plugin.empty()) identity += fmt::format("plugin = {}\n", experiment.plugin);
  if (!experiment.scenario_plugin.empty())
    identity += fmt::format("scenario_plugin = {}\n", experiment.scenario_plugin);
  if (!experiment.definition.empty()) identity += fmt::format("definition = {}\n", experiment.definition);
  if (!experiment.requirements.empty())
    identity += fmt::format("requirements = {}\n", experiment.requirements);
  if (!experiment.conditions.empty() && Reads(search, "conditions"))
    identity += fmt::format("conditions = {}\n", experiment.conditions);
  add("scenario_parameters", experiment.scenario_parameters);
  add("controller_parameters", experiment.controller_parameters);
  if (setup.row->handed_cases()) {
    identity +=
        fmt::format("list of cases = {} with hash {:016x}\n", setup.cases.size(), HashOf(setup.cases));
  }
  return identity;
}

}  // namespace gauntlet
