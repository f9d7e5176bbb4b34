#include "search/experiment/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <tuple>
#include <utility>

#include "base/nearest_name.h"
#include "base/system/sha256.h"
#include "controllers/command/definition.h"
#include "controllers/command/requirements.h"
#include "search/experiment/disturbance_keys.h"
#include "search/experiment/genome_ranges.h"
#include "search/experiment/objective.h"
#include "sim/arena/color.h"
#include "sim/arena/validity.h"

namespace gauntlet {
namespace {

// The key of what stands at Path in an Experiment.
template <auto... Path>
Key FieldKey(const std::string& path, const std::string& description) {
  return gauntlet::FieldKey<Experiment, Path...>(path, description);
}

template <auto... Path>
Key NumberKey(const std::string& path, const std::string& unit, double min, double max,
              const std::string& description) {
  return gauntlet::NumberKey<Experiment, Path...>(path, unit, min, max, description);
}

template <auto... Path>
Key ChoiceKey(const std::string& path, const std::vector<std::string>& choices,
              const std::string& description) {
  return gauntlet::ChoiceKey<Experiment, Path...>(path, choices, description);
}

Key ForPeople(Key key) {
  key.for_people = true;
  return key;
}

Key CameLater(Key key) {
  key.came_later = true;
  return key;
}

// Without friction, a model for tests.
constexpr const char* kUnlistedPhysics = "relaxation";

Key PhysicsKey() {
  Key key = ChoiceKey<&Experiment::physics>("physics", {"box2d", kUnlistedPhysics, "impulse"},
                                            "impulse = contacts as in ARGoS; box2d = Box2D's contacts");
  std::erase(key.choices, kUnlistedPhysics);
  key.unlisted_choices = {kUnlistedPhysics};
  return key;
}

Key ObjectiveKey() {
  Key key(
      "search.objective", KeyType::kChoice,
      "what is searched for: low fitness, short obstacles that make the swarm fail, frequent failures, or a "
      "low robustness of what [requirements] says");
  key.choices.assign(kObjectiveNames.begin(), kObjectiveNames.end());
  key.get = [](const Experiment& e) -> KeyValue {
    return std::string(kObjectiveNames.at(static_cast<std::size_t>(ObjectiveOf(e.search))));
  };
  key.set = [](Experiment& e, const KeyValue& v) {
    const auto found = std::ranges::find(kObjectiveNames, std::get<std::string>(v));
    e.search.parameters[std::string(kObjectiveParameter)] =
        static_cast<double>(found - kObjectiveNames.begin());
  };
  return key;
}

Key LightColorKey() {
  Key key("genome.light_color", KeyType::kChoice, "of those lights; birds are red, their prey is blue");
  key.choices.assign(sim::kColorNames.begin() + 1, sim::kColorNames.end());  // black is no light
  key.get = [](const Experiment& e) -> KeyValue { return std::string(sim::NameOf(e.genome.light_color)); };
  key.set = [](Experiment& e, const KeyValue& v) {
    e.genome.light_color = *sim::ColorNamed(std::get<std::string>(v));
  };
  return key;
}

Key AlgorithmKey(const Catalogue& catalogue) {
  Key key = FieldKey<&Experiment::search, &SearchSpec::algorithm>(
      "search.algorithm", "how test cases are found: gauntlet list searches");
  key.type = KeyType::kChoice;
  for (const SearchInfo& search : catalogue.searches) key.choices.emplace_back(search.name);
  return key;
}

// Keys "TABLE.NAME" of the parameters at Path.
template <auto... Path>
std::vector<Key> ParameterKeys(const std::string& table, std::span<const controllers::ParameterInfo> infos) {
  std::vector<Key> keys;
  for (const controllers::ParameterInfo& info : infos) {
    Key& key = keys.emplace_back();
    static_cast<KeyInfo&>(key) = controllers::KeyInfoOf(table + ".", info);
    key.get = [info](const Experiment& e) {
      return controllers::KeyValueOf(info, ValueOf(info, MemberAt<Path...>(e)));
    };
    key.rare = info.came_later;
    key.set = [info](Experiment& e, const KeyValue& v) {
      MemberAt<Path...>(e)[info.name] = NumberOf(v);
      if (info.came_later && NumberOf(v) == info.default_value) MemberAt<Path...>(e).erase(info.name);
    };
  }
  return keys;
}

// Of what all searches together read of their own table.
std::vector<Key> SearchKeys(const Catalogue& catalogue) {
  constexpr auto kSearch = &Experiment::search;
  std::vector<Key> keys = {
      NumberKey<kSearch, &SearchSpec::population>("search.population", "", 4, 10000,
                                                  "individuals, an even number (thesis Table 4.1)"),
      NumberKey<kSearch, &SearchSpec::generations>("search.generations", "", 1, 1e6,
                                                   "the initial population is generation 1"),
      ChoiceKey<kSearch, &SearchSpec::parent_selection>(
          "search.parent_selection",
          {"AllParent-BestHalf", "2BestParents-2WorseAway", "2RandomParents-2WorseAway"}, "thesis 3.2.3.3"),
      ChoiceKey<kSearch, &SearchSpec::crossover>(
          "search.crossover", {"single-point", "double-point", "uniform"}, "thesis 3.2.3.4"),
      NumberKey<kSearch, &SearchSpec::crossover_probability>("search.crossover_probability", "", 0.0, 1.0,
                                                             "per couple; otherwise children are copies"),
      NumberKey<kSearch, &SearchSpec::mutation_probability>("search.mutation_probability", "", 0.0, 1.0,
                                                            "per gene; a mutated gene is drawn anew"),
      ChoiceKey<kSearch, &SearchSpec::reevaluation>(
          "search.reevaluation", {"scheme", "population", "children"},
          "who is simulated in a generation; scheme = the children in AllParent-BestHalf, else everybody"),
      CameLater(FieldKey<kSearch, &SearchSpec::cells>(
          "search.cells",
          "METRIC:FROM:TO:PARTS, with spaces between several: how failures are told apart, instead of the "
          "scenario's own cells")),
      ChoiceKey<kSearch, &SearchSpec::aggregation>("search.fitness_aggregation", {"mean", "last"},
                                                   "how an individual's evaluations make its fitness"),
      CameLater(ObjectiveKey()),
      NumberKey<kSearch, &SearchSpec::replicates>("search.replicates", "", 1, 10000,
                                                  "runs per evaluation, each with its own seed"),
      NumberKey<kSearch, &SearchSpec::variation_tries>(
          "search.variation_tries", "", 1, 1e6,
          "of an offspring that breaks a validity rule; then the step leaves it unchanged"),
  };
  for (const SearchInfo& search : catalogue.searches) {
    for (Key& key : ParameterKeys<kSearch, &SearchSpec::parameters>("search", search.parameters)) {
      keys.push_back(std::move(key));
    }
  }
  return keys;
}

std::vector<Key> FitKeys(const Catalogue& catalogue) {
  constexpr auto kFit = &Experiment::fit;
  std::vector<Key> keys = {
      FieldKey<kFit, &FitSpec::vary>(
          "fit.vary", "KEY=LOW..HIGH, KEY=LOW..HIGH:log or KEY=A|B, with spaces between several"),
      FieldKey<kFit, &FitSpec::targets>("fit.targets", "what runs are to be like: gauntlet fit writes it"),
      NumberKey<kFit, &FitSpec::runs>("fit.runs", "", 1, 1e8,
                                      "for all settings together; those of the judgement come on top"),
      NumberKey<kFit, &FitSpec::judged>("fit.judged", "", 20, 1e5,
                                        "runs of the chosen setting on each kind of cases"),
      FieldKey<kFit, &FitSpec::search>("fit.search", "search.algorithm of the fitted experiment"),
  };
  keys.back().type = KeyType::kChoice;
  keys.back().choices = AlgorithmKey(catalogue).choices;
  for (Key& key : keys) key.rare = key.came_later = true;
  return keys;
}

std::vector<Key> MarginKeys() {
  constexpr auto kMargin = &Experiment::margin;
  std::vector<Key> keys = {
      FieldKey<kMargin, &MarginSpec::vary>("margin.vary", "KEY=LOW..HIGH or KEY=LOW..HIGH:log"),
      NumberKey<kMargin, &MarginSpec::runs>("margin.runs", "", 1, 1e8, "at most, over all values"),
      NumberKey<kMargin, &MarginSpec::share>("margin.share", "", 0.01, 0.99,
                                             "of failing runs, whose crossing is looked for"),
  };
  for (Key& key : keys) key.rare = key.came_later = true;
  return keys;
}

std::vector<Key> ProbabilityKeys() {
  constexpr auto kProbability = &Experiment::probability;
  std::vector<Key> keys = {
      NumberKey<kProbability, &ProbabilitySpec::below>("probability.below", "", 0, 0.999999,
                                                       "that the probability is compared with; 0 = none"),
      NumberKey<kProbability, &ProbabilitySpec::within>(
          "probability.within", "", 0, 1,
          "narrow enough: half the interval, as a share of the estimate; 0 = never"),
      NumberKey<kProbability, &ProbabilitySpec::runs>("probability.runs", "", 100, 1e8, "at most"),
      FieldKey<kProbability, &ProbabilitySpec::plain>("probability.plain",
                                                      "by plain samples, however rare failures are"),
      FieldKey<kProbability, &ProbabilitySpec::weights>(
          "probability.weights", "of given cases, with spaces between them; \"\" = equal ones"),
  };
  for (Key& key : keys) key.rare = key.came_later = true;
  return keys;
}

std::vector<Key> RepairKeys(const Catalogue& catalogue) {
  constexpr auto kRepair = &Experiment::repair;
  std::vector<Key> keys = {
      FieldKey<kRepair, &RepairSpec::vary>("repair.vary", "as fit.vary"),
      NumberKey<kRepair, &RepairSpec::runs>("repair.runs", "", 1, 1e8,
                                            "of the search; explanation and proof come on top"),
      NumberKey<kRepair, &RepairSpec::training>("repair.training", "", 0, 1e6, "cases that train"),
      NumberKey<kRepair, &RepairSpec::guards>("repair.guards", "", 0, 1e6, "random cases that guard them"),
      FieldKey<kRepair, &RepairSpec::units>("repair.units", "how many held-out cases belong together"),
      NumberKey<kRepair, &RepairSpec::fresh>("repair.fresh", "", 0, 1e6,
                                             "runs of each search against the repaired controller"),
      FieldKey<kRepair, &RepairSpec::search>("repair.search", "search.algorithm of the repaired experiment"),
  };
  keys.back().type = KeyType::kChoice;
  keys.back().choices = AlgorithmKey(catalogue).choices;
  for (Key& key : keys) key.rare = key.came_later = true;
  return keys;
}

constexpr double kLeastRectangleSide = controllers::command::kLeastArenaSide;

std::vector<Key> RectangleKeys() {
  constexpr auto kArena = &Experiment::arena;
  constexpr double kMost = sim::kMaxCoordinate;
  std::vector<Key> keys = {
      NumberKey<kArena, &ArenaSpec::x_min>(
          "arena.x_min", "m", -kMost, kMost,
          "with the next three the arena of a program, instead of arena.side "
          "and genome.position_*"),
      NumberKey<kArena, &ArenaSpec::x_max>("arena.x_max", "m", -kMost, kMost, "likewise"),
      NumberKey<kArena, &ArenaSpec::y_min>("arena.y_min", "m", -kMost, kMost, "likewise"),
      NumberKey<kArena, &ArenaSpec::y_max>("arena.y_max", "m", -kMost, kMost, "likewise"),
  };
  for (Key& key : keys) key.rare = key.came_later = true;
  return keys;
}

std::vector<Key> ArenaKeys() {
  constexpr auto kArena = &Experiment::arena;
  return {
      NumberKey<kArena, &ArenaSpec::side>("arena.side", "m", 1.0, 50.0,
                                          "between the centre lines of opposite walls (thesis 4.5.3)"),
      NumberKey<kArena, &ArenaSpec::wall_thickness>("arena.wall_thickness", "m", 0.01, 1.0,
                                                    "half of it stands inside the centre lines"),
  };
}

std::vector<Key> GenomeKeys() {
  constexpr auto kGenome = &Experiment::genome;
  return {
      NumberKey<kGenome, &GenomeSpec::genes>("genome.genes", "", 0, 64,
                                             "obstacles per test case (thesis Table 4.1)"),
      NumberKey<kGenome, &GenomeSpec::position_min>("genome.position_min", "m", -25.0, 25.0,
                                                    "least x and y of an obstacle's centre"),
      NumberKey<kGenome, &GenomeSpec::position_max>("genome.position_max", "m", -25.0, 25.0,
                                                    "largest x and y of an obstacle's centre"),
      NumberKey<kGenome, &GenomeSpec::length_min>("genome.length_min", "m", 0.01, 50.0, "shortest obstacle"),
      NumberKey<kGenome, &GenomeSpec::length_max>("genome.length_max", "m", 0.01, 50.0, "longest obstacle"),
      NumberKey<kGenome, &GenomeSpec::width_min>("genome.width_min", "m", 0.01, 50.0, "narrowest obstacle"),
      NumberKey<kGenome, &GenomeSpec::width_max>("genome.width_max", "m", 0.01, 50.0, "widest obstacle"),
      NumberKey<kGenome, &GenomeSpec::step>("genome.step", "m", 0.0, 1.0,
                                            "grid of positions and sizes; 0 = continuous"),
      NumberKey<kGenome, &GenomeSpec::moving>("genome.moving", "", 0.0, 1.0,
                                              "share of the obstacles that move (thesis 7.4)"),
      NumberKey<kGenome, &GenomeSpec::waypoints>("genome.waypoints", "", 1, sim::kMaxObstaclePath,
                                                 "places that they visit in turn; 1 = back and forth"),
      NumberKey<kGenome, &GenomeSpec::speed_min>("genome.speed_min", "m/s", 0.001, sim::kMaxObstacleSpeed,
                                                 "slowest moving obstacle"),
      NumberKey<kGenome, &GenomeSpec::speed_max>("genome.speed_max", "m/s", 0.001, sim::kMaxObstacleSpeed,
                                                 "fastest moving obstacle"),
      NumberKey<kGenome, &GenomeSpec::lights>("genome.lights", "", 0.0, 1.0,
                                              "share of the obstacles that carry lights (thesis 7.4)"),
      LightColorKey(),
      NumberKey<kGenome, &GenomeSpec::tries_per_gene>(
          "genome.tries_per_gene", "", 1, 1e6, "redraws of one obstacle before the whole case starts anew"),
  };
}

}  // namespace

std::vector<Key> CommonKeys(const Catalogue& catalogue) {
  std::vector<Key> keys = {
      ForPeople(
          FieldKey<&Experiment::name>("name", "names the campaign's folder; letters, digits and . _ -")),
      ForPeople(FieldKey<&Experiment::description>("description", "one line for people")),
      NumberKey<&Experiment::seed>("seed", "", 0.0, 18446744073709551615.0,
                                   "all seeds of test cases, variation and runs derive from it"),
      FieldKey<&Experiment::scenario>("scenario", "what the swarm has to do"),
      FieldKey<&Experiment::controller>("controller",
                                        "the algorithm under test; default: the scenario's own"),
      PhysicsKey(),
  };
  const auto add = [&](std::vector<Key> more, bool Key::*flag) {
    for (Key& key : more) {
      if (flag != nullptr) key.*flag = true;
      keys.push_back(std::move(key));
    }
  };
  add({FaultsKey()}, &Key::disturbs);
  add(ArenaKeys(), nullptr);
  add(RectangleKeys(), nullptr);
  add(GenomeKeys(), &Key::of_searches);
  add({AlgorithmKey(catalogue)}, nullptr);
  add(SearchKeys(catalogue), &Key::of_searches);
  add(FitKeys(catalogue), &Key::of_searches);
  add(MarginKeys(), &Key::of_searches);
  add(RepairKeys(catalogue), &Key::of_searches);
  add(ProbabilityKeys(), &Key::of_searches);
  add(RandomFaultKeys(), &Key::disturbs);
  add(NoiseKeys(), &Key::disturbs);
  add({FieldKey<&Experiment::store, &StoreSpec::trajectories>(
          "store.trajectories",
          "keep every robot's trajectory and the annotations of each run; without them replay computes them "
          "anew")},
      &Key::for_people);
  for (Key& key : keys) {
    key.default_value = key.get(Experiment{});
    key.came_later = key.came_later || key.disturbs;
  }
  return keys;
}

namespace {

template <auto kMember>
Key LibraryKey(const char* path, const char* description) {
  Key key = FieldKey<kMember>(path, description);
  key.default_value = std::string();
  key.check = [path](const KeyValue& v) -> std::optional<std::string> {
    const auto& text = std::get<std::string>(v);
    if (text.empty() || IsSha256(text)) return std::nullopt;
    return fmt::format("{} = {} is no SHA-256 of 64 hexadecimal digits; name files by plugins = [\"FILE\"]",
                       path, QuoteToml(text));
  };
  return key;
}

}  // namespace

Key PluginKey() {
  return LibraryKey<&Experiment::plugin>(
      "plugin", "SHA-256 of the library that brings the controller, in plugins/ beside this file");
}

Key ScenarioPluginKey() {
  return LibraryKey<&Experiment::scenario_plugin>(
      "scenario_plugin", "SHA-256 of the library that brings the scenario, in plugins/ beside this file");
}

double ValueOf(const controllers::ParameterInfo& info, const sim::Parameters& given) {
  const auto found = given.find(std::string(info.name));
  return found == given.end() ? info.default_value : found->second;
}

bool Reads(const SearchInfo& search, std::string_view path) {
  const auto own = [&](const controllers::ParameterInfo& info) {
    return path.starts_with("search.") && path.substr(7) == info.name;
  };
  return std::ranges::any_of(search.parameters, own) ||
         std::ranges::any_of(search.keys, [&](std::string_view key) {
           return key.ends_with('.') ? path.starts_with(key) : path == key;
         });
}

std::vector<Key> ScenarioParameterKeys(const controllers::ScenarioInfo& scenario) {
  return ParameterKeys<&Experiment::scenario_parameters>("scenario_parameters", scenario.parameters);
}

std::vector<Key> ControllerParameterKeys(const controllers::ControllerInfo& controller) {
  return ParameterKeys<&Experiment::controller_parameters>("controller_parameters", controller.parameters);
}

bool SaidByRectangle(const Experiment& experiment, std::string_view path) {
  constexpr std::array<std::string_view, 3> kSaid = {"arena.side", "genome.position_min",
                                                     "genome.position_max"};
  return experiment.arena.HasRectangle() && std::ranges::count(kSaid, path) > 0;
}

namespace {

// What a program of the user's knows nothing of.
std::optional<BrokenRule> CheckRulesOfCommand(const Experiment& experiment, const Catalogue& catalogue) {
  for (const Key& key : CommonKeys(catalogue)) {
    const bool meaningless =
        key.disturbs || key.path == "physics" || key.path == "genome.moving" || key.path == "genome.lights";
    if (!meaningless || key.get(experiment) == key.default_value) continue;
    return BrokenRule{key.path,
                      fmt::format("{} = {} is for this engine, and a program of yours simulates the "
                                  "runs of the scenario 'command': leave it out",
                                  key.path, ToToml(key.get(experiment)))};
  }
  return std::nullopt;
}

std::optional<BrokenRule> CheckRectangle(const Experiment& experiment) {
  const ArenaSpec& arena = experiment.arena;
  if (!arena.HasRectangle()) return std::nullopt;
  if (experiment.scenario != controllers::command::kScenario) {
    const auto keys = RectangleKeys();
    const auto given =
        std::ranges::find_if(keys, [&](const Key& key) { return key.get(experiment) != KeyValue(0.0); });
    return BrokenRule{given->path, fmt::format("{} = {}: arenas of this engine are squares around the "
                                               "origin: set arena.side",
                                               given->path, ToToml(given->get(experiment)))};
  }
  const sim::Vec2 sides = arena.Sides();
  for (const auto& [axis, min, max, side] :
       {std::tuple{"x", arena.x_min, arena.x_max, sides.x()}, {"y", arena.y_min, arena.y_max, sides.y()}}) {
    if (side >= kLeastRectangleSide && side <= sim::kMaxArenaSide) continue;
    return BrokenRule{
        fmt::format("arena.{}_max", axis),
        fmt::format("arena.{0}_min = {1} to arena.{0}_max = {2}: want {3} to {4} m between them "
                    "(a rectangle has x_min, x_max, y_min and y_max)",
                    axis, min, max, kLeastRectangleSide, sim::kMaxArenaSide)};
  }
  return std::nullopt;
}

std::optional<BrokenRule> CheckWalls(const ArenaSpec& arena) {
  const double shorter = arena.Sides().minCoeff();
  if (arena.wall_thickness <= shorter / 2.0) return std::nullopt;
  const std::string what = arena.HasRectangle() ? "the arena's shorter side" : "arena.side";
  return BrokenRule{"arena.wall_thickness",
                    fmt::format("arena.wall_thickness = {} must not exceed half of {} = {}",
                                arena.wall_thickness, what, shorter)};
}

}  // namespace

std::optional<BrokenRule> CheckRules(const Experiment& experiment, const Catalogue& catalogue) {
  if (!IsName(experiment.name)) {
    return BrokenRule{"name",
                      fmt::format("name = {} is no good folder name: use up to 64 letters, digits, '.', "
                                  "'_' or '-', and begin with none of '.' and '-'",
                                  QuoteToml(experiment.name))};
  }
  if (const auto broken = CheckRectangle(experiment)) return broken;
  if (const Status genome = CheckGenomeSpec(GenomeOf(experiment)); !genome.ok()) {
    const std::string& message = genome.error().message;
    return BrokenRule{message.substr(0, message.find(' ')), message};
  }
  if (experiment.scenario == controllers::command::kScenario) {
    if (auto broken = CheckRulesOfCommand(experiment, catalogue)) return broken;
  }
  if (const auto broken = CheckWalls(experiment.arena)) return broken;
  const SearchInfo* search = FindByName(catalogue.searches, experiment.search.algorithm);
  return search->check == nullptr ? std::nullopt : search->check(experiment);
}

}  // namespace gauntlet
