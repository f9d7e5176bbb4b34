// A swarm of one formula, whose settings are fitted in tests.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "search/experiment/experiment_file.h"
#include "search/fit/fit_rounds.h"
#include "search/search_table.h"
#include "sim/random/random_stream.h"

namespace gauntlet {

inline const std::string kToyVary =
    "controller_parameters.turn_rate=0.5..1.5 controller_parameters.bird_speed=0.01..0.1:log "
    "controller_parameters.turning_speed_factor=0..1";

inline Experiment FittedToy() {
  return ParseExperiment("", "toy.toml", {"scenario=flocking"}, BuiltInCatalogue()).value();
}

inline Result<FitPlan> ToyPlan(const FitSpec& spec) {
  Experiment experiment = FittedToy();
  experiment.fit = spec;
  return MakeFitPlan(experiment, AllKeysOf(experiment));
}

// A run at three places: its fitness moves and spreads with them, and so does how often birds are lost.
inline RunOutcome ToyRun(const SettingsPoint& place, sim::RandomStream& random) {
  const double speed = 2.0 * place[1] - 1.0;
  const double spread = 0.5 * std::exp(0.7 * speed) * (0.5 + place[2]);
  RunOutcome run;
  run.fitness = 3.0 * place[0] * place[0] + std::sin(2.0 * place[2]) + spread * random.Gaussian();
  const double lost = 1.0 / (1.0 + std::exp(2.0 - 4.0 * place[0] - 2.0 * speed * (place[2] - 0.3)));
  run.metrics = {{"birds_left", random.Chance(lost) ? 0.0 : 10.0}};
  return run;
}

inline constexpr const char* kToyTargets =
    "metric=fitness value={} n=100; statistic=sd metric=fitness value={} n=100; statistic=share value={} "
    "n=100 formula=birds_left == 0";

// What runs of a setting give for the targets of a plan.
inline std::vector<std::vector<double>> ToyValues(const std::vector<FitTarget>& targets,
                                                  const SettingsPoint& place, int runs,
                                                  sim::RandomStream& random) {
  TargetReader reader(targets, *controllers::FindScenario("flocking"));
  std::vector<std::vector<double>> values(targets.size());
  for (int i = 0; i < runs; ++i) {
    const std::vector<double> read = reader.Read(ToyRun(place, random));
    for (std::size_t t = 0; t < targets.size(); ++t) values[t].push_back(read[t]);
  }
  return values;
}

// Targets as measured on 100 runs of the hidden place.
inline std::string ToyMeasured(const SettingsPoint& hidden, sim::RandomStream& random) {
  const auto targets =
      ParseFitTargets(fmt::format(fmt::runtime(kToyTargets), 0, 0, 0), *controllers::FindScenario("flocking"))
          .value();
  const auto values = ToyValues(targets, hidden, 100, random);
  return fmt::format(fmt::runtime(kToyTargets), StatisticOf(targets[0], values[0])[0],
                     StatisticOf(targets[1], values[1])[0], StatisticOf(targets[2], values[2])[0]);
}

// Where a setting stands in the three ranges of kToyVary; in the middle of those that do not vary.
inline SettingsPoint ToyPlaceOf(const FitPlan& plan, const FitSetting& setting) {
  static const std::vector<VariedKey> all =
      ToyPlan({.vary = kToyVary, .targets = "metric=fitness value=1 n=9"})->varied;
  const std::vector<KeyValue> values = setting.ValuesOf(plan.varied);
  SettingsPoint place(all.size(), 0.5);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k].key.path == plan.varied[i].key.path) place[k] = all[k].PlaceOf(values[i]);
    }
  }
  return place;
}

// Simulates what the fit asks for, to its end.
inline void Finish(FitRounds& rounds, sim::RandomStream& random) {
  const FitPlan& plan = rounds.plan();
  TargetReader reader(plan.targets, *controllers::FindScenario("flocking"));
  while (true) {
    std::vector<SettingsPoint> places = rounds.Propose();
    if (places.empty()) return;
    places.resize(std::min(places.size(), rounds.wanted()));
    rounds.Begin(places);
    const std::size_t first = rounds.settings().size() - places.size();
    for (std::size_t i = first; i < rounds.settings().size(); ++i) {
      const SettingsPoint place = ToyPlaceOf(plan, rounds.settings()[i]);
      for (std::size_t cases = 0; cases < plan.cases.size(); ++cases) {
        const int runs = rounds.judging() ? plan.judged[cases] : plan.runs[cases];
        for (int run = 0; run < runs; ++run) rounds.Tell(i, cases, ToyRun(place, random), reader);
      }
    }
  }
}

inline bool Everywhere(const SettingsPoint& /*place*/) {
  return true;
}

}  // namespace gauntlet
