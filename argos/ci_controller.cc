#include <argos3/core/control_interface/ci_controller.h>

#include <algorithm>

namespace argos {
namespace {

template <typename Device>
Device* Find(const std::map<std::string, Device*>& devices, const std::string& tag, const char* kind,
             std::vector<std::string>& asked_for) {
  const auto found = devices.find(tag);
  if (found == devices.end()) {
    throw CARGoSException("The robot has no " + std::string(kind) + " \"" + tag +
                          "\"; it has those of its .argos file, or those that Init asks for");
  }
  if (std::find(asked_for.begin(), asked_for.end(), tag) == asked_for.end()) asked_for.push_back(tag);
  return found->second;
}

}  // namespace

CCI_Controller::~CCI_Controller() {
  for (const auto& [tag, actuator] : m_mapActuators) delete actuator;
  for (const auto& [tag, sensor] : m_mapSensors) delete sensor;
}

CCI_Actuator* CCI_Controller::FindActuator(const std::string& tag) {
  return Find(m_mapActuators, tag, "actuator", actuators_asked_for_);
}

CCI_Sensor* CCI_Controller::FindSensor(const std::string& tag) {
  return Find(m_mapSensors, tag, "sensor", sensors_asked_for_);
}

}  // namespace argos
