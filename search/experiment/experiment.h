// An experiment: everything a campaign depends on but the machine. Read from TOML, changed by --set, written
// back resolved.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "sim/arena/color.h"
#include "sim/arena/test_case.h"
#include "sim/run_spec.h"

namespace gauntlet {

// Ranges that generated genes are drawn from.
struct GenomeSpec {
  int genes = 8;               // obstacles per test case (thesis Table 4.1)
  double position_min = -3.0;  // m, centre x and y
  double position_max = 3.0;   // m
  double length_min = 0.4;     // m
  double length_max = 2.0;     // m
  double width_min = 0.1;      // m
  double width_max = 0.4;      // m
  double step = 0.1;  // m, grid of positions and sizes (the thesis' files carry one decimal); 0 = continuous
  double moving = 0.0;      // share of the genes that move (thesis 7.4)
  int waypoints = 1;        // points that they go to; 1 = back and forth
  double speed_min = 0.01;  // m/s
  double speed_max = 0.03;  // m/s
  double lights = 0.0;      // share of the genes that carry lights (thesis 7.4)
  sim::Color light_color = sim::Color::kRed;
  int tries_per_gene = 500;                   // redraws of one gene before the whole case starts anew
  std::optional<sim::Rectangle> places = {};  // of centres, instead of position_min to position_max both ways

  sim::Rectangle Places() const {
    return places.value_or(sim::Rectangle{{position_min, position_min}, {position_max, position_max}});
  }
};

enum class ParentSelection { kAllParentBestHalf, kTwoBestParentsTwoWorseAway, kTwoRandomParentsTwoWorseAway };
enum class CrossoverKind { kSinglePoint, kDoublePoint, kUniform };
// Who is simulated in a generation: everybody with new seeds, or the newborn only. kScheme = as thesis
// 3.2.3.3 does it for the parent selection: everybody in the two-parent schemes, children only in
// AllParent-BestHalf.
enum class Reevaluation { kScheme, kPopulation, kChildren };
enum class FitnessAggregation { kMean, kLast };

// How test cases are searched for. Which of these a search reads, its row says (SearchInfo).
struct SearchSpec {
  std::string algorithm = "genetic";  // the name of a SearchInfo
  int population = 20;
  int generations = 50;
  ParentSelection parent_selection = ParentSelection::kTwoBestParentsTwoWorseAway;
  CrossoverKind crossover = CrossoverKind::kSinglePoint;
  double crossover_probability = 0.1;  // per couple
  double mutation_probability = 0.05;  // per gene; a mutated gene is drawn anew as a whole
  Reevaluation reevaluation = Reevaluation::kScheme;
  FitnessAggregation aggregation = FitnessAggregation::kMean;
  int replicates = 1;          // runs per evaluation
  int variation_tries = 100;   // of an offspring that breaks a validity rule; then it becomes a copy
  std::string cells;           // failure_cells.h; "" = those that the scenario declares
  sim::Parameters parameters;  // what one search alone reads (SearchInfo::parameters); missing = its default
};

struct ArenaSpec {
  double side = 6.0;            // m
  double wall_thickness = 0.1;  // m
  // The rectangle that a program's arena is instead, m; all 0: there is none.
  double x_min = 0.0;
  double x_max = 0.0;
  double y_min = 0.0;
  double y_max = 0.0;

  bool HasRectangle() const { return x_min != 0.0 || x_max != 0.0 || y_min != 0.0 || y_max != 0.0; }
  // m. Decimals stay decimals: 0.3 - 0.2 is 0.1.
  sim::Vec2 Sides() const {
    return HasRectangle() ? ToNanometres({x_max - x_min, y_max - y_min}) : sim::Vec2(side, side);
  }
  sim::Vec2 Center() const { return ToNanometres(sim::Vec2(x_min + x_max, y_min + y_max) / 2.0); }

 private:
  static sim::Vec2 ToNanometres(const sim::Vec2& metres) {
    return {std::round(metres.x() * 1e9) / 1e9, std::round(metres.y() * 1e9) / 1e9};
  }
};

// What is kept of a run. No influence on any result.
struct StoreSpec {
  bool trajectories = false;  // the robots' waypoints and the annotations too; replay computes them anyway
};

// What a fit is asked for (search/fit).
struct FitSpec {
  std::string vary;                // VariedKey::ToText, blanks in between
  std::string targets;             // FitTarget::ToText, "; " in between
  int runs = 20'000;               // for all settings together; those of the judgement come on top
  int judged = 1'000;              // of the chosen setting on each kind of cases
  std::string search = "genetic";  // of the fitted experiment, in place of the fit
};

// What a margin is asked for (search/margin).
struct MarginSpec {
  std::string vary;    // VariedKey::ToText, of one key
  int runs = 600;      // at most
  double share = 0.5;  // of failures, that they are to cross
};

// What a repair is asked for (search/repair). Cases are handed in: those of the training part, the random
// ones that guard it, the held-out ones, and the random ones that judge.
struct RepairSpec {
  std::string vary;   // VariedKey::ToText, blanks in between
  int runs = 5000;    // of the search; explanation and proof come on top
  int training = 0;   // cases
  int guards = 0;     // cases
  std::string units;  // of held-out cases: how many belong together, in their order, blanks in between
  int fresh = 1000;   // runs of each search that begins anew against the repaired controller; 0 = none
  std::string search = "genetic";  // of the repaired experiment, in place of the repair
};

// What is asked of a failure probability (search/probability).
struct ProbabilitySpec {
  double below = 0.0;    // that it is compared with; 0 = none
  double within = 0.25;  // narrow enough: half the interval, as a share of the estimate; 0 = never
  int runs = 20'000;     // at most
  bool plain = false;    // by plain samples, however rare failures are
  std::string weights;   // of given cases, blanks in between; "" = equal ones
};

struct Experiment : sim::RunSettings {
  std::string name;
  std::string description;
  ArenaSpec arena;
  GenomeSpec genome;
  SearchSpec search;
  FitSpec fit;
  MarginSpec margin;
  RepairSpec repair;
  ProbabilitySpec probability;
  // What is drawn of it and from which distribution, VariedKey::ToText with blanks in between: the table
  // [conditions].
  std::string conditions;
  std::uint64_t seed = 1;
  StoreSpec store;
};

// Its genome, whose obstacles stand in the arena's rectangle when there is one.
inline GenomeSpec GenomeOf(const Experiment& experiment) {
  GenomeSpec genome = experiment.genome;
  const ArenaSpec& arena = experiment.arena;
  if (arena.HasRectangle())
    genome.places = sim::Rectangle{{arena.x_min, arena.y_min}, {arena.x_max, arena.y_max}};
  return genome;
}

// A run with the experiment's settings. Those that its search asks for: SpecOfRun (search_table.h).
inline sim::RunSpec SpecOf(const Experiment& experiment, const sim::TestCase& test_case, std::uint64_t seed) {
  return {experiment, test_case, seed};
}

}  // namespace gauntlet
