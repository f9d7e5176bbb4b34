// Of a small ARGoS project: foot-bots cross an arena towards a light. It has a fault: see Crossing::ControlStep.
#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_light_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_proximity_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>

using namespace argos;

class Crossing : public CCI_Controller {
 public:
  void Init(TConfigurationNode& params) override {
    wheels_ = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
    proximity_ = GetSensor<CCI_FootBotProximitySensor>("footbot_proximity");
    light_ = GetSensor<CCI_FootBotLightSensor>("footbot_light");
    GetNodeAttribute(params, "speed", speed_);
    GetNodeAttributeOrDefault(params, "near", near_, near_);
    GetNodeAttributeOrDefault(params, "both_sides", both_sides_, both_sides_);
    GetNodeAttributeOrDefault(params, "along", along_after_, along_after_);
  }

  void ControlStep() override {
    CVector2 obstacle;
    for (const auto& reading : proximity_->GetReadings()) obstacle += CVector2(reading.Value, reading.Angle);
    CVector2 light;
    for (const auto& reading : light_->GetReadings()) light += CVector2(reading.Value, reading.Angle);
    const bool ahead = obstacle.Length() > near_ && Abs(obstacle.Angle()) < CRadians::PI_OVER_TWO;
    if (ahead) {
      // The fault: it always turns to its left, also where the way around is on its right.
      const bool left = both_sides_ == 0 || obstacle.Angle() <= CRadians::ZERO;
      Turn(left);
      along_ = along_after_;
      return;
    }
    if (along_ > 0) {
      --along_;
      wheels_->SetLinearVelocity(speed_, speed_);
      return;
    }
    const CRadians turn = light.Angle();
    if (light.Length() > 0.0 && Abs(turn) > CRadians::PI / 12.0) {
      Turn(turn > CRadians::ZERO);
      return;
    }
    wheels_->SetLinearVelocity(speed_, speed_);
  }

 private:
  void Turn(bool left) {
    const Real speed = speed_ / 2.0;
    wheels_->SetLinearVelocity(left ? -speed : speed, left ? speed : -speed);
  }

  CCI_DifferentialSteeringActuator* wheels_ = nullptr;
  CCI_FootBotProximitySensor* proximity_ = nullptr;
  CCI_FootBotLightSensor* light_ = nullptr;
  Real speed_ = 10.0;  // cm/s
  Real near_ = 0.1;
  UInt32 both_sides_ = 0;
  UInt32 along_after_ = 6;  // ticks
  UInt32 along_ = 0;  // ticks for which it still drives straight on
};
REGISTER_CONTROLLER(Crossing, "crossing_controller")
