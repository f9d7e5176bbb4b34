// The LEDs: a ring of 12, and number 12, the beacon. Black is off.
#pragma once

#include <cstddef>
#include <vector>

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_LEDsActuator : public CCI_Actuator {
 public:
  using TSettings = std::vector<CColor>;

  explicit CCI_LEDsActuator(std::size_t leds = 13) : m_tSettings(leds) {}

  std::size_t GetNumLEDs() const { return m_tSettings.size(); }
  // Throws when there is no such LED.
  virtual void SetSingleColor(UInt32 led, const CColor& color) { m_tSettings.at(led) = color; }
  virtual void SetAllColors(const CColor& color) { m_tSettings.assign(m_tSettings.size(), color); }
  // One colour for each; throws when there are more or fewer.
  virtual void SetAllColors(const TSettings& colors) {
    if (colors.size() != m_tSettings.size()) throw CARGoSException("LEDs: one colour is needed for each");
    m_tSettings = colors;
  }
  virtual void SetSingleIntensity(UInt32 led, UInt8 intensity) { m_tSettings.at(led).SetAlpha(intensity); }
  virtual void SetAllIntensities(UInt8 intensity) {
    for (CColor& color : m_tSettings) color.SetAlpha(intensity);
  }
  void Reset() override { SetAllColors(CColor::BLACK); }

 protected:
  TSettings m_tSettings;
};

}  // namespace argos
