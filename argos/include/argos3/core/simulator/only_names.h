// What controllers' sources include without use, or mention by name: parts of ARGoS' simulator. What stands
// in the arena is the scenario's matter.
#pragma once

#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/simulator/physics_engine/physics_engine.h>

namespace argos {

// What signals go through.
class CMedium {};
class CLEDMedium : public CMedium {};
class CRABMedium : public CMedium {};

class CDynamics2DEngine : public CPhysicsEngine {};
class CPhysicsModel {};

class CComposableEntity : public CEntity {};
class CPositionalEntity : public CEntity {};
class CBoxEntity : public CEntity {};
class CCylinderEntity : public CEntity {};
class CLEDEntity : public CEntity {};
class CWheeledEntity : public CEntity {};
class CBatteryEquippedEntity : public CEntity {};
class CFootBotDistanceScannerEquippedEntity : public CEntity {};
class CFootBotTurretEntity : public CEntity {};
class CGripperEquippedEntity : public CEntity {};
class CGroundSensorEquippedEntity : public CEntity {};
class CLEDEquippedEntity : public CEntity {};
class CLightSensorEquippedEntity : public CEntity {};
class COmnidirectionalCameraEquippedEntity : public CEntity {};
class CPerspectiveCameraEquippedEntity : public CEntity {};
class CProximitySensorEquippedEntity : public CEntity {};
class CRABEquippedEntity : public CEntity {};
class CSimpleRadioEquippedEntity : public CEntity {};

}  // namespace argos
