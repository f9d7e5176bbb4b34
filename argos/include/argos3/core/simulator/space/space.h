// The arena, of which a controller knows the time only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/simulator/entity/floor_entity.h>
#include <argos3/core/utility/datatypes/any.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CSpace {
 public:
  using TMapPerType = std::map<std::string, CAny>;

  // Ticks since the beginning of the run; 1 in the first ControlStep.
  UInt32 GetSimulationClock() const { return clock_; }
  void SetSimulationClock(UInt32 clock) { clock_ = clock; }

  ARGOS_UNAVAILABLE(
      TMapPerType&, GetEntitiesByType,
      "a controller of Gauntlet does not reach other robots; let them speak by range_and_bearing")
  ARGOS_UNAVAILABLE(TMapPerType&, GetEntityMapPerTypePerId,
                    "a controller of Gauntlet does not reach what else is in the arena")
  ARGOS_UNAVAILABLE(std::vector<CEntity*>&, GetRootEntityVector,
                    "a controller of Gauntlet does not reach what else is in the arena")
  ARGOS_UNAVAILABLE(const CRange<CVector3>&, GetArenaLimits,
                    "a controller of Gauntlet is not told; make it a parameter")
  ARGOS_UNAVAILABLE(CEntity&, GetEntity, "a controller of Gauntlet does not reach what else is in the arena")
  ARGOS_UNAVAILABLE(CFloorEntity&, GetFloorEntity,
                    "the scenario paints the floor; read it by a ground sensor")
  ARGOS_UNAVAILABLE(const CVector3&, GetArenaSize,
                    "a controller of Gauntlet is not told; make it a parameter")

 private:
  UInt32 clock_ = 0;
};

}  // namespace argos
