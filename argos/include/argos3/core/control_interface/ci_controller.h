// A robot's controller, as ARGoS has it, and the macro that registers one.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <typeinfo>
#include <unordered_map>
#include <vector>

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/plugins/factory.h>

namespace argos {

class CCI_Controller : public CBaseConfigurableResource {
 public:
  CCI_Controller() = default;
  CCI_Controller(const CCI_Controller&) = delete;
  CCI_Controller& operator=(const CCI_Controller&) = delete;
  ~CCI_Controller() override;  // with its devices

  // In every tick, after the sensors have read. Commands act in the next tick.
  virtual void ControlStep() {}

  const std::string& GetId() const { return m_strId; }
  void SetId(const std::string& id) { m_strId = id; }

  // The device with this tag. Throws when the robot has none, or when it is of another class.
  template <typename Actuator>
  Actuator* GetActuator(const std::string& tag) {
    return Cast<Actuator>(FindActuator(tag), tag);
  }
  template <typename Sensor>
  Sensor* GetSensor(const std::string& tag) {
    return Cast<Sensor>(FindSensor(tag), tag);
  }
  bool HasActuator(const std::string& tag) const { return m_mapActuators.count(tag) > 0; }
  bool HasSensor(const std::string& tag) const { return m_mapSensors.count(tag) > 0; }
  CCI_Actuator::TMap& GetAllActuators() { return m_mapActuators; }
  CCI_Sensor::TMap& GetAllSensors() { return m_mapSensors; }
  void AddActuator(const std::string& tag, CCI_Actuator* actuator) { m_mapActuators[tag] = actuator; }
  void AddSensor(const std::string& tag, CCI_Sensor* sensor) { m_mapSensors[tag] = sensor; }

  // The tags that were asked for: what its robot needs, in any case.
  const std::vector<std::string>& ActuatorsAskedFor() const { return actuators_asked_for_; }
  const std::vector<std::string>& SensorsAskedFor() const { return sensors_asked_for_; }

 protected:
  CCI_Actuator::TMap m_mapActuators;
  CCI_Sensor::TMap m_mapSensors;
  std::string m_strId;

 private:
  CCI_Actuator* FindActuator(const std::string& tag);
  CCI_Sensor* FindSensor(const std::string& tag);

  template <typename Device, typename Base>
  static Device* Cast(Base* device, const std::string& tag) {
    if (auto* const cast = dynamic_cast<Device*>(device)) return cast;
    throw CARGoSException("The device \"" + tag + "\" is no " + typeid(Device).name());
  }

  std::vector<std::string> actuators_asked_for_;
  std::vector<std::string> sensors_asked_for_;
};

}  // namespace argos

// At file scope, with a plain class name; a semicolon may follow.
#define REGISTER_CONTROLLER(CLASSNAME, LABEL)                                                                \
  namespace argos {                                                                                          \
  static const CFactory<CCI_Controller>::CRegistration registration_of_##CLASSNAME(LABEL,                    \
                                                                                   []() -> CCI_Controller* { \
                                                                                     return new CLASSNAME;   \
                                                                                   });                       \
  }
