#include "master/search/search_setup.h"

#include <fmt/format.h>

#include <sstream>
#include <string_view>

#include "base/check.h"
#include "sim/robot/disturbances.h"

namespace gauntlet::master {
namespace {

// Marks the beginning of a state: "GNT_SRCH" in the bytes of the file.
constexpr std::uint64_t kStateMagic = 0x485243535F544E47ULL;

std::string ParameterLines(std::string_view prefix, const sim::Parameters& parameters) {
  std::string lines;
  for (const auto& [name, value] : parameters) lines += fmt::format("{}.{} = {}\n", prefix, name, value);
  return lines;
}

Error Mismatch(const std::string& saved, const std::string& here) {
  std::istringstream saved_lines(saved);
  std::istringstream here_lines(here);
  std::string saved_line;
  std::string here_line;
  while (std::getline(saved_lines, saved_line) && std::getline(here_lines, here_line) &&
         saved_line == here_line) {
  }
  return InvalidInput(
      fmt::format("the saved search state belongs to another experiment: it has '{}', this one has '{}'",
                  saved_line, here_line));
}

}  // namespace

sim::TestCase EmptyArena(const ArenaSpec& arena) {
  sim::TestCase test_case;
  test_case.side_x = arena.side;
  test_case.side_y = arena.side;
  test_case.wall_thickness = arena.wall_thickness;
  return test_case;
}

GenomeGenerator MakeGenerator(const SearchSetup& setup) {
  return {setup.experiment.genome, EmptyArena(setup.experiment.arena), setup.requirements};
}

std::uint64_t SearchSeed(const SearchSetup& setup) {
  return sim::DeriveSeed(setup.experiment.seed, sim::SeedPurpose::kSearch, setup.search_id,
                         /*individual=*/0, /*evaluation=*/0,
                         static_cast<std::uint32_t>(setup.experiment.search.kind));
}

sim::RandomStream GenomeStream(std::uint64_t search_seed, std::uint64_t id) {
  GAUNTLET_CHECK(id <= 0xFFFFFFFFULL, fmt::format("individual {}", id));
  return {search_seed, sim::StreamPurpose::kGenome, static_cast<std::uint32_t>(id)};
}

std::string SearchIdentity(const SearchSetup& setup) {
  const Experiment& e = setup.experiment;
  std::string identity = fmt::format("seed = {}\nsearch = {}\nscenario = {}\ncontroller = {}\n", e.seed,
                                     setup.search_id, e.scenario, e.controller);
  identity += ParameterLines("scenario_parameters", e.scenario_parameters);
  identity += ParameterLines("controller_parameters", e.controller_parameters);
  identity +=
      fmt::format("arena.side = {}\narena.wall_thickness = {}\n", e.arena.side, e.arena.wall_thickness);
  identity +=
      fmt::format("start = {} {}\ngoal = {} {}\nclearance = {}\ninflation = {}\n",
                  setup.requirements.start.x(), setup.requirements.start.y(), setup.requirements.goal.x(),
                  setup.requirements.goal.y(), setup.requirements.clearance, setup.requirements.inflation);
  for (const auto& [key, value] : sim::DisturbanceTexts(e.disturbances)) {
    identity += fmt::format("{} = {}\n", key, value);
  }
  const GenomeSpec& g = e.genome;
  identity += fmt::format("genome.genes = {}\ngenome.position = {} {}\ngenome.length = {} {}\n", g.genes,
                          g.position_min, g.position_max, g.length_min, g.length_max);
  identity += fmt::format("genome.width = {} {}\ngenome.step = {}\ngenome.tries_per_gene = {}\n", g.width_min,
                          g.width_max, g.step, g.tries_per_gene);
  if (g.moving > 0.0) {
    identity += fmt::format("genome.moving = {}\ngenome.waypoints = {}\ngenome.speed = {} {}\n", g.moving,
                            g.waypoints, g.speed_min, g.speed_max);
  }
  if (g.lights > 0.0) {
    identity +=
        fmt::format("genome.lights = {}\ngenome.light_color = {}\n", g.lights, sim::NameOf(g.light_color));
  }
  const SearchSpec& s = e.search;
  identity +=
      fmt::format("search.algorithm = {}\nsearch.replicates = {}\n", static_cast<int>(s.kind), s.replicates);
  if (s.kind != SearchKind::kGenetic) return identity;
  identity += fmt::format(
      "search.population = {}\nsearch.parent_selection = {}\nsearch.crossover = {}\n"
      "search.crossover_probability = {}\nsearch.mutation_probability = {}\nsearch.reevaluation = {}\n"
      "search.fitness_aggregation = {}\nsearch.variation_tries = {}\n",
      s.population, static_cast<int>(s.parent_selection), static_cast<int>(s.crossover),
      s.crossover_probability, s.mutation_probability, static_cast<int>(s.reevaluation),
      static_cast<int>(s.aggregation), s.variation_tries);
  if (s.mode == SearchMode::kSteadyState)
    identity += fmt::format("search.mode = 1\nsearch.lag = {}\n", LagOf(s));
  return identity;
}

void WriteStateHead(std::uint64_t format, const SearchSetup& setup, CanonicalEncoder& encoder) {
  encoder.Uint(kStateMagic);
  encoder.Uint(format);
  encoder.String(SearchIdentity(setup));
}

Status ReadStateHead(std::uint64_t format, const SearchSetup& setup, CanonicalDecoder& decoder) {
  const std::uint64_t magic = decoder.Uint();
  const std::uint64_t found_format = decoder.Uint();
  if (!decoder.ok() || magic != kStateMagic) {
    return Error{ErrorKind::kCorrupt, "the saved search state is damaged: it has no valid beginning"};
  }
  if (found_format != format) {
    return Error{
        ErrorKind::kVersion,
        fmt::format("the saved search state has format {}, this version reads {}", found_format, format)};
  }
  const std::string identity = decoder.String();
  if (!decoder.ok()) return Error{ErrorKind::kCorrupt, "the saved search state is cut off"};
  const std::string expected = SearchIdentity(setup);
  if (identity != expected) return Mismatch(identity, expected);
  return Ok{};
}

}  // namespace gauntlet::master
