// A controller for ARGoS, to copy: robots attract and repel each other by a Lennard-Jones force and are drawn
// by a light. It is compiled as it is, for ARGoS and by `gauntlet build-controller light_flocking.cc --argos
// light_flocking.argos`.
#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_light_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_colored_blob_omnidirectional_camera_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_leds_actuator.h>

using namespace argos;

class CLightFlocking : public CCI_Controller {
 public:
  void Init(TConfigurationNode& parameters) override {
    wheels_ = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
    leds_ = GetActuator<CCI_LEDsActuator>("leds");
    light_ = GetSensor<CCI_FootBotLightSensor>("footbot_light");
    camera_ = GetSensor<CCI_ColoredBlobOmnidirectionalCameraSensor>("colored_blob_omnidirectional_camera");
    TConfigurationNode& flocking = GetNode(parameters, "flocking");
    GetNodeAttribute(flocking, "target_distance", target_distance_);
    GetNodeAttribute(flocking, "gain", gain_);
    GetNodeAttribute(flocking, "exponent", exponent_);
    GetNodeAttributeOrDefault(flocking, "cutoff", cutoff_, cutoff_);
    GetNodeAttributeOrDefault(flocking, "light_share", light_share_, light_share_);
    TConfigurationNode& turning = GetNode(parameters, "wheel_turning");
    GetNodeAttribute(turning, "max_speed", max_speed_);
    no_turn_ = AngleOf(turning, "no_turn_angle_threshold");
    soft_turn_ = AngleOf(turning, "soft_turn_angle_threshold");
    hard_turn_ = AngleOf(turning, "hard_turn_angle_threshold");
    Reset();
  }

  void Reset() override {
    turning_ = NONE;
    camera_->Enable();
    leds_->SetSingleColor(12, CColor::RED);
  }

  void ControlStep() override { Drive(FlockingVelocity() + LightVelocity()); }

 private:
  enum ETurning { NONE, SOFT, HARD };

  static CRadians AngleOf(TConfigurationNode& node, const std::string& name) {
    CDegrees angle;
    GetNodeAttribute(node, name, angle);
    return ToRadians(angle);
  }

  // The mean force of the flockmates, at most max_speed_ long.
  CVector2 FlockingVelocity() const {
    CVector2 sum;
    UInt32 count = 0;
    for (const auto* blob : camera_->GetReadings().BlobList) {
      if (blob->Color != CColor::RED || blob->Distance >= cutoff_ * target_distance_) continue;
      if (blob->Distance > 0.0) sum += CVector2(Attraction(blob->Distance), blob->Angle);
      ++count;
    }
    if (count == 0) return CVector2();
    sum /= count;
    const Real speed = sum.Length();
    return speed > max_speed_ ? sum * (max_speed_ / speed) : sum;
  }

  // Towards a flockmate that is so many cm away, cm/s.
  Real Attraction(Real distance) const {
    const Real far = Max<Real>(distance, 1.0);
    Real term = 1.0;
    for (UInt32 i = 0; i < exponent_; ++i) term *= target_distance_ / far;
    return gain_ / far * (term - term * term);
  }

  CVector2 LightVelocity() const {
    CVector2 sum;
    for (const auto& reading : light_->GetReadings()) sum += CVector2(reading.Value, reading.Angle);
    const Real length = sum.Length();
    return length > 0.0 ? sum * (light_share_ * max_speed_ / length) : CVector2();
  }

  void Drive(const CVector2& velocity) {
    const CRadians bearing = velocity.Angle();
    const CRadians angle = Abs(bearing);
    const Real speed = Min<Real>(velocity.Length(), max_speed_);
    if (turning_ == HARD && angle <= soft_turn_) turning_ = SOFT;
    if (turning_ != HARD) turning_ = angle > hard_turn_ ? HARD : angle > no_turn_ ? SOFT : NONE;
    Real inner = speed;
    Real outer = speed;
    if (turning_ == SOFT) {
      const Real share = angle / hard_turn_;
      inner = speed * (1.0 - share);
      outer = speed * (1.0 + share);
    } else if (turning_ == HARD) {
      inner = -max_speed_;
      outer = max_speed_;
    }
    const bool left = bearing > CRadians::ZERO;
    wheels_->SetLinearVelocity(left ? inner : outer, left ? outer : inner);
  }

  CCI_DifferentialSteeringActuator* wheels_ = nullptr;
  CCI_LEDsActuator* leds_ = nullptr;
  CCI_FootBotLightSensor* light_ = nullptr;
  CCI_ColoredBlobOmnidirectionalCameraSensor* camera_ = nullptr;
  Real target_distance_ = 0.0;  // cm
  Real gain_ = 0.0;             // cm^2/s
  UInt32 exponent_ = 0;
  Real cutoff_ = 1.8;        // of the target distance
  Real light_share_ = 0.25;  // of the largest speed
  Real max_speed_ = 0.0;     // cm/s
  CRadians no_turn_;
  CRadians soft_turn_;
  CRadians hard_turn_;
  ETurning turning_ = NONE;
};

REGISTER_CONTROLLER(CLightFlocking, "light_flocking_controller")
