// A controller written for ARGoS as one of ours. In a run all robots' controllers are made one after the
// other and are gone before those of the next run are made: they share ARGoS' random numbers, its clock and
// the colours.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "argos/devices.h"
#include "sim/robot/controller.h"

#include <argos3/core/control_interface/ci_controller.h>

namespace gauntlet::argos_form {

// What an .argos file says of a controller.
struct ControllerSection {
  std::string label;  // what it is registered as
  // The tags of its devices; nothing: every device there is, and the robot has those that Init asks for.
  struct Devices {
    std::vector<std::string> actuators;
    std::vector<std::string> sensors;
  };
  std::optional<Devices> devices = {};
  argos::TConfigurationNode parameters = argos::TConfigurationNode("params");
  std::string robots = "fb";                          // what their ids begin with; their numbers follow
  std::size_t message_bytes = sim::Payload().size();  // rab_data_size: of a message of range_and_bearing
};

class ControllerAdapter final : public sim::Controller {
 public:
  struct Robot {
    sim::RobotIndex number = 0;
    std::uint64_t seed = 0;  // of the run
    sim::Pose start;
  };

  // Makes the controller and its devices and calls Init. Throws argos::CARGoSException, or what Init throws,
  // when that fails.
  ControllerAdapter(const ControllerSection& section, const Robot& robot);
  ControllerAdapter(const ControllerAdapter&) = delete;
  ControllerAdapter& operator=(const ControllerAdapter&) = delete;
  ~ControllerAdapter() override;

  sim::DeviceSet Devices() const override { return devices_; }
  sim::DeviceSet Attention(bool holding_item) const override;
  // What Init has commanded.
  void Begin(sim::Actuators& actuators) override;
  // Throws what ControlStep throws.
  void Step(const sim::ControlStep& step) override;

  argos::CCI_Controller& controller() { return *controller_; }

 private:
  // One of its devices.
  template <typename Face, typename Link>
  struct Part : Linked<Face, Link> {
    const DeviceRow<Face, Link>* row;
  };

  void AddDevices(const ControllerSection& section);
  // Those that are named, or all when null. Throws of a name that is none of ours.
  template <typename Row, typename Parts, typename Map>
  void Add(std::span<const Row> rows, const char* kind, const std::vector<std::string>* named, Parts& parts,
           Map& map);
  // Takes the devices away that were not asked for, unless null; the robot has the rest.
  template <typename Parts, typename Map>
  void Equip(Parts& parts, Map& map, const std::vector<std::string>* asked_for);

  std::shared_ptr<RunParts> run_;
  RobotParts parts_;
  std::unique_ptr<argos::CCI_Controller> controller_;
  std::vector<Part<argos::CCI_Sensor, SensorLink>> sensors_;
  std::vector<Part<argos::CCI_Actuator, ActuatorLink>> actuators_;
  argos::CCI_Sensor* camera_ = nullptr;  // if it has one
  sim::DeviceSet devices_;
  sim::DeviceSet devices_without_camera_;
};

}  // namespace gauntlet::argos_form
