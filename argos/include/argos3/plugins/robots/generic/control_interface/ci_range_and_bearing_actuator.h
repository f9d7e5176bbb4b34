// What a robot says to those around it, in every tick.
#pragma once

#include <cstddef>

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/byte_array.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_RangeAndBearingActuator : public CCI_Actuator {
 public:
  explicit CCI_RangeAndBearingActuator(std::size_t size = 10) : m_cData(size) {}

  std::size_t GetSize() const { return m_cData.Size(); }
  // Throws when there is no such byte.
  virtual void SetData(std::size_t index, UInt8 value) {
    if (index >= m_cData.Size()) {
      THROW_ARGOSEXCEPTION("range_and_bearing: byte " << index << " of a message of " << m_cData.Size()
                                                      << "; rab_data_size of the foot-bots in the .argos "
                                                         "file says how many there are");
    }
    m_cData[index] = value;
  }
  // Throws when it has another size.
  virtual void SetData(const CByteArray& data) {
    if (data.Size() != m_cData.Size()) {
      THROW_ARGOSEXCEPTION("range_and_bearing: a message of " << data.Size() << " bytes; it has "
                                                              << m_cData.Size());
    }
    m_cData = data;
  }
  virtual void ClearData() { m_cData.Zero(); }
  void Reset() override { ClearData(); }

 protected:
  CByteArray m_cData;
};

}  // namespace argos
