#include <argos3/core/simulator/simulator.h>
#include <argos3/core/utility/logging/argos_log.h>

namespace argos {

CARGoSLog LOG(std::cout);
CARGoSLog LOGERR(std::cerr);

CSimulator& CSimulator::GetInstance() {
  static CSimulator simulator;
  return simulator;
}

}  // namespace argos
