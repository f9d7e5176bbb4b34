#include "search/experiment/disturbance_keys.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "sim/arena/test_case.h"
#include "sim/robot/disturbances.h"

namespace gauntlet {
namespace {

template <auto Member>
Key RandomFaultKey(const std::string& path, double max, const std::string& description) {
  return gauntlet::NumberKey<Experiment, &Experiment::disturbances, &sim::Disturbances::random_faults,
                             Member>(path, "", 0, max, description);
}

// "noise.proximity.gaussian": one number of one device.
Key NoiseKey(const sim::DeviceInfo& noisy, const std::string& name, double sim::DeviceNoise::*member,
             const std::string& description) {
  Key key(fmt::format("noise.{}.{}", sim::KeyOf(noisy.device), name), KeyType::kNumber, description);
  key.max = noisy.most_noise;
  key.unit = noisy.noise_unit;
  key.get = [device = noisy.device, member](const Experiment& e) -> KeyValue {
    const auto found = e.disturbances.noise.find(device);
    return found == e.disturbances.noise.end() ? 0.0 : found->second.*member;
  };
  key.set = [device = noisy.device, member](Experiment& e, const KeyValue& v) {
    e.disturbances.noise[device].*member = std::get<double>(v);
    if (!e.disturbances.noise[device].Any()) e.disturbances.noise.erase(device);
  };
  return key;
}

}  // namespace

Key FaultsKey() {
  Key key("faults", KeyType::kText,
          "ROBOT:WHAT@TICK, with spaces between several: 3:wheels@500 9:stopped@0; WHAT is a device or "
          "'stopped'; robots count from 0, and in flocking the prey comes behind the birds: with 10 of "
          "them it is robot 10");
  key.get = [](const Experiment& e) -> KeyValue { return sim::FaultsText(e.disturbances.faults); };
  key.set = [](Experiment& e, const KeyValue& v) {
    e.disturbances.faults = *sim::ParseFaults(std::get<std::string>(v));
  };
  key.check = [](const KeyValue& v) -> std::optional<std::string> {
    const auto faults = sim::ParseFaults(std::get<std::string>(v));
    if (faults.ok()) return std::nullopt;
    return "faults: " + faults.error().message;
  };
  return key;
}

std::vector<Key> RandomFaultKeys() {
  using sim::RandomFaults;
  Key what("random_faults.what", KeyType::kChoice, "what fails of them: a device, or all of it");
  what.choices = sim::FaultNames();
  what.get = [](const Experiment& e) -> KeyValue {
    return sim::FaultName(e.disturbances.random_faults.device);
  };
  what.set = [](Experiment& e, const KeyValue& v) {
    e.disturbances.random_faults.device = sim::DeviceOfKey(std::get<std::string>(v));
  };
  std::vector<Key> keys = {
      RandomFaultKey<&RandomFaults::count>(
          "random_faults.count", sim::kMaxRobots,
          "robots of each run that have a fault, drawn by the run's seed, beside those of 'faults'"),
      what,
      RandomFaultKey<&RandomFaults::tick>("random_faults.tick", sim::kLatestFault, "from which they have it"),
      gauntlet::ChoiceKey<Experiment, &Experiment::disturbances, &sim::Disturbances::random_faults,
                          &RandomFaults::role>("random_faults.role",
                                               {sim::kFaultyRoles.begin(), sim::kFaultyRoles.end()},
                                               "drawn of the robots of the controller under test, or "
                                               "also of the scenario's own, such as the prey")};
  for (Key& key : keys) key.rare = true;
  return keys;
}

std::vector<Key> NoiseKeys() {
  std::vector<Key> keys;
  for (const sim::DeviceInfo& noisy : sim::kDevices) {
    if (noisy.most_noise == 0.0) continue;
    keys.push_back(NoiseKey(noisy, "uniform", &sim::DeviceNoise::uniform,
                            fmt::format("half width of a uniform error {}", noisy.noise_error)));
    keys.push_back(NoiseKey(noisy, "gaussian", &sim::DeviceNoise::gaussian,
                            "standard deviation of a Gaussian one, likewise"));
    if (!noisy.drops) continue;
    keys.push_back(NoiseKey(noisy, "drop", &sim::DeviceNoise::drop, "probability that one is not received"));
    keys.back().max = 1.0;
    keys.back().unit = "";
  }
  return keys;
}

bool NobodyIsDrawn(const Experiment& experiment, std::string_view path) {
  return path.starts_with("random_faults.") && experiment.disturbances.random_faults.count == 0;
}

}  // namespace gauntlet
