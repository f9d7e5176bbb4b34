// What a repair has come to: which parameter is at fault, what would mend it, and the proof.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "analysis/tables/section.h"
#include "base/result.h"
#include "search/repair/repair_course.h"
#include "study/repairs/repair_change.h"
#include "study/repairs/repair_proof.h"

namespace gauntlet {

// One of the parameters that vary.
struct RepairedKey {
  VariedKey key;
  KeyValue original;
  KeyValue repaired;
  std::optional<KeyValue> alone;  // the value that does best in training with all others original
  double failing_alone = 0.0;     // of held-out runs, with that value
  double failing_without = 0.0;   // likewise, all repaired but this one
  int mended_alone = 0;           // held-out cases
  std::vector<std::string> flags;
};

struct Repair {
  Experiment experiment;
  std::shared_ptr<const SearchAlgorithm> search;  // that holds the course
  bool finished = false;
  std::vector<sim::TestCase> cases;
  std::vector<FreshSearch> fresh = {};

  const RepairCourse& course() const { return *search->Repair(); }
  const RepairPlan& plan() const { return course().plan(); }
};
// Error: those of OpenStoredCampaign; it holds no repair.
Result<Repair> ReadRepair(const std::string& dir);

// Of a repair that has come to its end; nothing without such cases.
std::optional<RepairChange> ChangeInHeldOut(const Repair& repair);
std::optional<RepairChange> ChangeInTraining(const Repair& repair);
std::optional<RepairChange> ChangeInRandom(const Repair& repair);
std::vector<RepairedKey> KeysOf(const Repair& repair);

// What was counted along the range of a key, all others original, in the training cases that draw curves.
struct RepairLevel {
  KeyValue value;
  int runs = 0;
  int failures = 0;
};
std::vector<RepairLevel> RepairCurve(const Repair& repair, std::size_t key);
Table RepairCurveTable(const Repair& repair, std::size_t key);

// Whether it is mended, and by how much: a sentence.
std::string OutcomeOf(const Repair& repair);
// Whether failures became rarer by at least .05, beyond chance, in ten held-out cases or more.
bool IsMended(const Repair& repair);
// The experiment with the repaired parameters, and as a file.
Experiment RepairedExperiment(const Repair& repair);
std::string RepairedToml(const Repair& repair, const std::string& dir);

std::vector<Section> TellRepair(const Repair& repair, const std::string& dir, const std::string& program);
std::string RepairJson(const Repair& repair, const std::string& dir);

}  // namespace gauntlet
