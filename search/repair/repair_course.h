// The course of a repair, pure: which settings of a controller are simulated in which cases, given what came
// of earlier ones. First each key is varied alone; then the best values join as long as they do better
// together; from there CMA-ES looks for the settings that fail least in the training cases and, as their
// guard, in random ones; at last the chosen settings are judged in cases that took no part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "search/repair/cma_es.h"
#include "search/settings/settings_course.h"

namespace gauntlet {

// The cases, in the order in which they are handed in.
struct RepairCases {
  std::size_t training = 0;        // that failed
  std::size_t guards = 0;          // random ones
  std::vector<std::size_t> units;  // held-out ones that failed: how many belong together, one after the other
  std::size_t random = 0;          // that judge

  std::size_t held_out() const;
  std::size_t first_held_out() const { return training + guards; }
  std::size_t first_random() const { return first_held_out() + held_out(); }
};

struct RepairPlan {
  static constexpr std::size_t kCurveValues = 9;
  static constexpr std::size_t kCurveCases = 20;  // of the training ones, at most
  static constexpr std::size_t kProofRuns = 3;    // of each setting in each case that failed

  std::vector<VariedKey> varied;
  std::vector<KeyValue> original;
  int runs = 0;  // of the search
  RepairCases cases;
  double time_limit = 0.0;  // s, of a run
  std::uint64_t seed = 0;   // of its random numbers

  // At most.
  std::uint64_t RunsOfCurves() const;
  std::uint64_t RunsOfProof() const;
};

// Of experiment.repair, with so many cases. Error: that of ParseVariedKeys; an original value outside its
// range; fewer cases than repair.training, guards and units say; too few runs for a generation, and how many
// are needed.
Result<RepairPlan> MakeRepairPlan(const Experiment& experiment, std::span<const Key> keys, std::size_t cases,
                                  std::uint64_t seed);

// What came of runs.
struct RepairTally {
  int runs = 0;
  int failures = 0;  // without a result among them
  int without_result = 0;
  int timeouts = 0;                         // simulated to the time limit
  int counted = 0;                          // whose contacts were counted
  std::vector<double> fitness;              // of the runs with a result
  SideEffects effects = {.contacts = 0.0};  // sums over them

  void Add(const RepairTally& other);
  double Share() const { return runs == 0 ? 0.0 : static_cast<double>(failures) / runs; }
};

class RepairCourse final : public SettingsCourse {
 public:
  // `failing` as FailingOf gives it.
  RepairCourse(RepairPlan plan, std::string_view failing);

  const std::vector<VariedKey>& varied() const override { return plan_.varied; }
  std::vector<KeyValue> ValuesOf(std::size_t setting) const override { return settings_[setting]; }
  std::vector<SettingsRun> Next() override;
  void Tell(const SettingsRun& run, const RunOutcome& outcome) override;
  bool AtEnd() const override { return stage_ == Stage::kProof; }
  std::size_t stages() const override { return stages_; }
  std::uint64_t RunsPlanned() const override;
  bool WantsMetrics() const override { return true; }

  const RepairPlan& plan() const { return plan_; }
  static constexpr std::size_t kOriginal = 0;   // the first setting
  static constexpr double kMoreContacts = 1.1;  // times the original's
  std::size_t generations() const { return generations_; }
  std::uint64_t searched() const { return searched_; }  // runs of the search
  // Settings; nothing before they are known.
  std::optional<std::size_t> repaired() const { return repaired_; }
  // Of one key, the rest original, by value.
  const std::vector<std::size_t>& CurveOf(std::size_t key) const { return curves_[key]; }
  // The curve's setting that fails least in training; nothing where none fails less than the original.
  std::optional<std::size_t> AloneOf(std::size_t key) const { return alone_[key]; }
  // The repaired settings with the key's original value; nothing where that is the repaired one's, too.
  std::optional<std::size_t> AllButOf(std::size_t key) const { return all_but_[key]; }
  // Of the setting in a case, and in `count` cases from `first` on.
  RepairTally TallyOf(std::size_t setting, std::size_t of_case) const;
  RepairTally TallyOf(std::size_t setting, std::size_t first, std::size_t count) const;
  // The training cases in which curves are drawn.
  std::vector<std::size_t> CurveCases() const;

 private:
  enum class Stage { kStart, kBaseline, kCurves, kJoining, kSearch, kChoice, kProof };

  SettingsPoint PlaceOf(const std::vector<KeyValue>& values) const;
  std::size_t AddSetting(std::vector<KeyValue> values);
  std::size_t AddRounded(const SettingsPoint& place);
  RepairTally Sum(std::size_t setting, std::span<const std::size_t> cases) const;

  // Failures in training and guards, and what side effects add: lower is better.
  double ScoreOf(std::size_t setting, std::span<const std::size_t> cases) const;
  bool Better(std::size_t one, std::size_t other, std::span<const std::size_t> cases) const;
  void BeginGeneration();
  std::vector<SettingsRun> NextBlock();
  void DropHopeless();
  void EndGeneration();
  std::uint64_t RunsOfGeneration() const;
  std::vector<SettingsRun> BeginCurves();
  void ReadCurves();
  std::vector<SettingsRun> JoinNext();
  std::vector<SettingsRun> BeginChoice();
  std::vector<SettingsRun> BeginProof();

  const RepairPlan plan_;
  const std::string_view failing_;
  CmaEs cma_;
  std::size_t start_ = kOriginal;  // its first mean
  Stage stage_ = Stage::kStart;
  std::size_t stages_ = 0;
  std::size_t generations_ = 0;
  std::uint64_t searched_ = 0;
  std::vector<std::vector<KeyValue>> settings_;
  std::vector<std::map<std::size_t, RepairTally>> tallies_;  // by setting and case
  // Of the generation: its settings in CMA-ES' order, those in the race, and its cases.
  std::vector<std::size_t> candidates_;
  std::vector<std::size_t> racing_;
  std::vector<std::size_t> cases_;
  std::size_t simulated_ = 0;         // of these cases, by those in the race
  std::vector<SettingsPoint> means_;  // after each generation; steadier than its best candidate
  std::vector<std::pair<std::size_t, KeyValue>> joining_;  // keys and their values, the best alone first
  std::size_t tried_ = 0;                                  // of them
  std::optional<std::size_t> joined_;                      // the setting with the last one of these
  std::vector<std::size_t> chosen_from_;
  std::optional<std::size_t> repaired_;
  std::vector<std::vector<std::size_t>> curves_;
  std::vector<std::optional<std::size_t>> alone_;
  std::vector<std::optional<std::size_t>> all_but_;
};

}  // namespace gauntlet
