#include <algorithm>

#include "argos/controller_adapter.h"

#include <argos3/core/simulator/simulator.h>
#include <argos3/core/utility/math/rng.h>

namespace gauntlet::argos_form {
namespace {

constexpr const char* kCategory = "argos";

// What the robots share of the run whose first one this is, or of the run that has begun. A new run has new
// random numbers and the time 0; ARGoS itself takes the first generator of a run.
std::shared_ptr<RunParts> JoinRun(std::uint64_t seed) {
  static std::weak_ptr<RunParts> running;
  if (std::shared_ptr<RunParts> run = running.lock()) return run;
  const auto short_seed = static_cast<argos::UInt32>(seed ^ seed >> 32);
  argos::CRandom::RemoveCategory(kCategory);
  argos::CRandom::CreateCategory(kCategory, short_seed);
  argos::CRandom::CreateRNG(kCategory);
  argos::CSimulator::GetInstance().SetRandomSeed(short_seed);
  argos::CSimulator::GetInstance().GetSpace().SetSimulationClock(0);
  auto run = std::make_shared<RunParts>();
  running = run;
  return run;
}

bool Has(const std::vector<std::string>& tags, std::string_view tag) {
  return std::ranges::find(tags, tag) != tags.end();
}

}  // namespace

ControllerAdapter::ControllerAdapter(const ControllerSection& section, const Robot& robot)
    : run_(JoinRun(robot.seed)),
      parts_{.palette = run_->palette,
             .mailbox = run_->mailbox,
             .directions = run_->directions,
             .robot = robot.number,
             .message_bytes = section.message_bytes,
             .start = robot.start},
      controller_(argos::CFactory<argos::CCI_Controller>::New(section.label)) {
  controller_->SetId(section.robots + std::to_string(robot.number));
  AddDevices(section);
  argos::TConfigurationNode parameters = section.parameters;
  controller_->Init(parameters);
  Equip(actuators_, controller_->GetAllActuators(),
        section.devices ? nullptr : &controller_->ActuatorsAskedFor());
  Equip(sensors_, controller_->GetAllSensors(), section.devices ? nullptr : &controller_->SensorsAskedFor());
  for (const auto& sensor : sensors_) {
    if (sensor.row->devices == sim::Device::kOmnidirectionalCamera) camera_ = sensor.face;
  }
}

ControllerAdapter::~ControllerAdapter() {
  for (const auto& sensor : sensors_) sensor.face->Destroy();
  for (const auto& actuator : actuators_) actuator.face->Destroy();
  controller_->Destroy();
}

void ControllerAdapter::AddDevices(const ControllerSection& section) {
  const auto* const named = section.devices ? &*section.devices : nullptr;
  Add(ActuatorRows(), "actuator", named ? &named->actuators : nullptr, actuators_,
      controller_->GetAllActuators());
  Add(SensorRows(), "sensor", named ? &named->sensors : nullptr, sensors_, controller_->GetAllSensors());
  for (const auto& sensor : sensors_) {
    if (sensor.row->devices != sim::Device::kOmnidirectionalCamera) sensor.face->Enable();
  }
}

template <typename Row, typename Parts, typename Map>
void ControllerAdapter::Add(std::span<const Row> rows, const char* kind,
                            const std::vector<std::string>* named, Parts& parts, Map& map) {
  for (const std::string& tag : named ? *named : std::vector<std::string>()) {
    if (std::ranges::find(rows, tag, &Row::tag) == rows.end())
      throw argos::CARGoSException("the robot has no " + std::string(kind) + " \"" + tag + "\"");
  }
  for (const Row& row : rows) {
    if (named && !Has(*named, row.tag)) continue;
    const auto made = row.make(parts_);
    parts.push_back({made, &row});
    map[std::string(row.tag)] = made.face;
  }
}

template <typename Parts, typename Map>
void ControllerAdapter::Equip(Parts& parts, Map& map, const std::vector<std::string>* asked_for) {
  std::erase_if(parts, [&](const auto& part) {
    if (asked_for == nullptr || Has(*asked_for, part.row->tag)) return false;
    map.erase(std::string(part.row->tag));
    delete part.face;
    return true;
  });
  for (const auto& part : parts) {
    devices_ = devices_ | part.row->devices;
    if (part.row->devices == sim::Device::kOmnidirectionalCamera) continue;
    devices_without_camera_ = devices_without_camera_ | part.row->devices;
  }
}

sim::DeviceSet ControllerAdapter::Attention(bool /*holding_item*/) const {
  return camera_ != nullptr && camera_->IsEnabled() ? devices_ : devices_without_camera_;
}

void ControllerAdapter::Begin(sim::Actuators& actuators) {
  for (const auto& actuator : actuators_) actuator.link->Give(actuators);
}

void ControllerAdapter::Step(const sim::ControlStep& step) {
  argos::CSimulator::GetInstance().GetSpace().SetSimulationClock(static_cast<argos::UInt32>(step.tick));
  for (const auto& sensor : sensors_) {
    if (sensor.face->IsEnabled()) sensor.link->Take(step.readings);
  }
  controller_->ControlStep();
  for (const auto& actuator : actuators_) actuator.link->Give(step.actuators);
}

}  // namespace gauntlet::argos_form
