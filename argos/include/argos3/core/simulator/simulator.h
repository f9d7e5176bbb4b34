// The simulator, of which a controller knows the time and the seed only.
#pragma once

#include <string>
#include <vector>

#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/simulator/physics_engine/physics_engine.h>
#include <argos3/core/simulator/space/space.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/rng.h>

namespace argos {

class CSimulator {
 public:
  static CSimulator& GetInstance();

  CSpace& GetSpace() { return space_; }
  UInt32 GetRandomSeed() const { return random_seed_; }
  void SetRandomSeed(UInt32 seed) { random_seed_ = seed; }
  CPhysicsEngine& GetPhysicsEngine(const std::string& /*id*/) { return physics_engine_; }

  ARGOS_UNAVAILABLE(CLoopFunctions&, GetLoopFunctions,
                    "Gauntlet runs no loop functions; a controller gets what it needs by its sensors")
  ARGOS_UNAVAILABLE(UInt32, GetMaxSimulationClock,
                    "a controller of Gauntlet is not told when the run ends; make it a parameter")
  ARGOS_UNAVAILABLE(bool, IsExperimentFinished,
                    "a controller of Gauntlet is not asked any more when the run is over")
  ARGOS_UNAVAILABLE(std::string, GetExperimentFileName, "there is no experiment file in a run of Gauntlet")
  ARGOS_UNAVAILABLE(TConfigurationNode&, GetConfigurationRoot,
                    "a controller of Gauntlet has the parameters that Init gets; what it needs belongs there")
  ARGOS_UNAVAILABLE(std::vector<CPhysicsEngine*>&, GetPhysicsEngines,
                    "a controller of Gauntlet does not reach physics; the tick is "
                    "CPhysicsEngine::GetSimulationClockTick()")
  ARGOS_UNAVAILABLE(CRandom::CRNG*, GetRNG, "use CRandom::CreateRNG(\"argos\")")
  ARGOS_UNAVAILABLE(void, Terminate, "a controller of Gauntlet does not end the run; its scenario does")

 private:
  CSpace space_;
  CPhysicsEngine physics_engine_;
  UInt32 random_seed_ = 0;
};

}  // namespace argos
