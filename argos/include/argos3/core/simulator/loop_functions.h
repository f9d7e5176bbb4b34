// What goes on around the robots. In Gauntlet that is the matter of a scenario; the class is here so that
// sources which mention theirs compile.
#pragma once

#include <string>

#include <argos3/core/simulator/space/space.h>
#include <argos3/core/utility/configuration/base_configurable_resource.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/vector2.h>

namespace argos {

class CSimulator;

class CLoopFunctions : public CBaseConfigurableResource {
 public:
  virtual void PreStep() {}
  virtual void PostStep() {}
  virtual bool IsExperimentFinished() { return false; }
  virtual void PostExperiment() {}
  virtual CColor GetFloorColor(const CVector2& /*point*/) { return CColor::WHITE; }

  ARGOS_UNAVAILABLE(CSpace&, GetSpace,
                    "Gauntlet runs no loop functions; write a scenario, which judges the swarm")
  ARGOS_UNAVAILABLE(CSimulator&, GetSimulator, "Gauntlet runs no loop functions; write a scenario")
  ARGOS_UNAVAILABLE(void, AddEntity,
                    "Gauntlet runs no loop functions; a scenario and its test case fill the arena")
  ARGOS_UNAVAILABLE(void, RemoveEntity,
                    "Gauntlet runs no loop functions; a scenario and its test case fill the arena")
  ARGOS_UNAVAILABLE(bool, MoveEntity, "Gauntlet runs no loop functions; nothing moves robots but themselves")
};

}  // namespace argos

#define REGISTER_LOOP_FUNCTIONS(CLASSNAME, LABEL) \
  static_assert(                                  \
      false,                                      \
      LABEL ": Gauntlet runs no loop functions; leave this source out, and let a scenario judge the swarm");

// Sources rely on it coming along; it needs the class above.
#include <argos3/core/simulator/simulator.h>
