#include <map>
#include <utility>
#include <vector>

#include "argos/devices.h"

#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_base_ground_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_distance_scanner_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_light_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_motor_ground_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_proximity_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_turret_encoder_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_wheel_speed_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_battery_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_colored_blob_omnidirectional_camera_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_ground_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_positioning_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_sensor.h>

namespace gauntlet::argos_form {
namespace {

using argos::CBearing;
using argos::CRadians;
using sim::Device;

constexpr double kCentimetres = 100.0;  // in a metre

// Sets the values of readings that are as many as these.
template <typename Readings, typename Values>
void TakeValues(Readings& readings, const Values& values) {
  for (std::size_t i = 0; i < values.size(); ++i) readings[i].Value = static_cast<double>(values[i]);
}

// Bearings to the last bit as our sensors have them, with their sines.
template <typename Readings>
void SetBearings(Readings& readings) {
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double bearing = sim::ProximityBearing(static_cast<int>(i));
    const sim::SinCos both = sim::SineCosine(bearing);
    readings[i].Angle = CBearing(bearing, both.sin, both.cos);
  }
}

class Proximity final : public argos::CCI_FootBotProximitySensor, public SensorLink {
 public:
  Proximity() { SetBearings(m_tReadings); }
  void Take(const sim::SensorReadings& readings) override { TakeValues(m_tReadings, readings.proximity); }
};

class Light final : public argos::CCI_FootBotLightSensor, public SensorLink {
 public:
  Light() { SetBearings(m_tReadings); }
  void Take(const sim::SensorReadings& readings) override { TakeValues(m_tReadings, readings.light); }
};

CBearing BearingOf(const sim::Directions& directions, std::size_t i) {
  return {directions.Angle(i), directions.Sine(i), directions.Cosine(i)};
}

class MotorGround final : public argos::CCI_FootBotMotorGroundSensor, public SensorLink {
 public:
  void Take(const sim::SensorReadings& readings) override { TakeValues(m_tReadings, readings.motor_ground); }
};

class BaseGround final : public argos::CCI_FootBotBaseGroundSensor, public SensorLink {
 public:
  void Take(const sim::SensorReadings& readings) override { TakeValues(m_tReadings, readings.base_ground); }
};

class Ground final : public argos::CCI_GroundSensor, public SensorLink {
 public:
  void Take(const sim::SensorReadings& readings) override {
    const auto next =
        std::copy(readings.motor_ground.begin(), readings.motor_ground.end(), m_tReadings.begin());
    std::copy(readings.base_ground.begin(), readings.base_ground.end(), next);
  }
};

class Camera final : public argos::CCI_ColoredBlobOmnidirectionalCameraSensor, public SensorLink {
 public:
  explicit Camera(RobotParts& parts) : palette_(parts.palette), directions_(parts.directions), blobs_(kRoom) {
    m_sReadings.BlobList.reserve(kRoom);
  }
  void Take(const sim::SensorReadings& readings) override {
    const std::span<const sim::Blob> blobs = readings.blobs;
    if (blobs_.size() < blobs.size()) blobs_.resize(2 * blobs.size());
    directions_.WorkOut(blobs);
    m_sReadings.BlobList.resize(blobs.size());
    for (std::size_t i = 0; i < blobs.size(); ++i) {
      SBlob& seen = blobs_[i];
      seen.Color = palette_.ColorOf(blobs[i].color);
      seen.Angle = BearingOf(directions_, i);
      seen.Distance = blobs[i].range * kCentimetres;
      m_sReadings.BlobList[i] = &seen;
    }
    ++m_sReadings.Counter;
  }

 private:
  static constexpr std::size_t kRoom = 128;  // blobs that it sees without more memory

  const Palette& palette_;
  sim::Directions& directions_;
  std::vector<SBlob> blobs_;  // kept from tick to tick
};

class Radio final : public argos::CCI_RangeAndBearingSensor, public SensorLink {
 public:
  explicit Radio(RobotParts& parts) : parts_(parts), directions_(parts.directions), spare_(kRoom) {
    for (SPacket& packet : spare_) packet.Data.Resize(parts.message_bytes);
    m_tReadings.reserve(kRoom);
  }
  void Take(const sim::SensorReadings& readings) override {
    Resize(readings.range_and_bearing.size());
    directions_.WorkOut(readings.range_and_bearing);
    for (std::size_t i = 0; i < m_tReadings.size(); ++i) {
      const sim::Message& message = readings.range_and_bearing[i];
      SPacket& packet = m_tReadings[i];
      packet.Range = message.range * kCentimetres;
      packet.HorizontalBearing = BearingOf(directions_, i);
      Fill(packet.Data, message.payload);
    }
  }

 private:
  void Fill(argos::CByteArray& data, const sim::Payload& message) const {
    data.Resize(parts_.message_bytes);
    std::span<const std::uint8_t> bytes = message;
    if (data.Size() > message.size()) {
      data.Zero();
      if (const auto kept = parts_.mailbox.Get(message); !kept.empty()) bytes = kept;
    }
    std::copy_n(bytes.begin(), std::min(bytes.size(), data.Size()), data.ToCArray());
  }
  // Packets that are not needed wait with their memory.
  void Resize(std::size_t size) {
    for (; m_tReadings.size() > size; m_tReadings.pop_back()) spare_.push_back(std::move(m_tReadings.back()));
    for (; m_tReadings.size() < size && !spare_.empty(); spare_.pop_back()) {
      m_tReadings.push_back(std::move(spare_.back()));
    }
    m_tReadings.resize(size);
  }

  static constexpr std::size_t kRoom = 32;  // packets that it hears without more memory

  const RobotParts& parts_;
  sim::Directions& directions_;
  std::vector<SPacket> spare_;
};

class Positioning final : public argos::CCI_PositioningSensor, public SensorLink {
 public:
  explicit Positioning(RobotParts& parts) { Set(parts.start); }
  void Take(const sim::SensorReadings& readings) override { Set(readings.pose); }

 private:
  void Set(const sim::Pose& pose) {
    m_sReading.Position.Set(pose.position.x(), pose.position.y(), 0.0);
    m_sReading.Orientation.FromAngleAxis(CRadians(pose.heading), argos::CVector3::Z);
  }
};

class WheelEncoders final : public argos::CCI_DifferentialSteeringSensor, public SensorLink {
 public:
  void Take(const sim::SensorReadings& readings) override {
    m_sReading.VelocityLeftWheel = readings.wheels.left * kCentimetres;
    m_sReading.VelocityRightWheel = readings.wheels.right * kCentimetres;
    m_sReading.CoveredDistanceLeftWheel = m_sReading.VelocityLeftWheel * sim::kTickSeconds;
    m_sReading.CoveredDistanceRightWheel = m_sReading.VelocityRightWheel * sim::kTickSeconds;
  }
};

class WheelSpeed final : public argos::CCI_FootBotWheelSpeedSensor, public SensorLink {
 public:
  void Take(const sim::SensorReadings& readings) override {
    m_sReading.LinearVelocityLeft = readings.wheels.left * kCentimetres;
    m_sReading.LinearVelocityRight = readings.wheels.right * kCentimetres;
  }
};

class TurretEncoder final : public argos::CCI_FootBotTurretEncoderSensor, public SensorLink {
 public:
  explicit TurretEncoder(RobotParts& parts) : parts_(parts) {}
  void Take(const sim::SensorReadings& /*readings*/) override { m_cRotation.SetValue(parts_.turret); }

 private:
  const RobotParts& parts_;
};

class Battery final : public argos::CCI_BatterySensor, public SensorLink {
 public:
  void Take(const sim::SensorReadings& /*readings*/) override {}
};

// Readings have the angles that ARGoS' footbot_distance_scanner_rotzonly_sensor computes for them, to the
// last bit: controllers keep maps by angle. (ARGoS takes a clockwise turn for a long one the other way; here
// it is a turn back.)
class Scanner final : public argos::CCI_FootBotDistanceScannerSensor, public SensorLink {
 public:
  explicit Scanner(RobotParts& parts) : parts_(parts) {}
  void Take(const sim::SensorReadings& readings) override {
    for (TReadingsMap* const map : {&m_tReadingsMap, &m_tShortReadingsMap, &m_tLongReadingsMap}) Empty(*map);
    if (readings.scanner_short.empty()) return;
    const CRadians from = before_;
    before_ = parts_.scanner;
    if (readings.scanner_short.size() == 2) {
      // It rests: each sensor's angle comes from that of the last one.
      CRadians angle = before_;
      for (std::size_t side = 0; side < 2; ++side) {
        Add(angle.SignedNormalize(), readings.scanner_short[side], m_tShortReadingsMap);
        angle += CRadians::PI_OVER_TWO;
        Add(angle.SignedNormalize(), readings.scanner_long[side], m_tLongReadingsMap);
        angle += CRadians::PI_OVER_TWO;
      }
      return;
    }
    CRadians turned = parts_.scanner - from;
    turned.UnsignedNormalize();
    const bool clockwise = turned > CRadians::PI;
    const std::size_t rays = readings.scanner_short.size() / 2;
    const CRadians span = clockwise ? (turned - CRadians::TWO_PI) / static_cast<double>(rays)
                                    : turned / static_cast<double>(rays);
    AddTurning(from, span, readings.scanner_short.first(rays), m_tShortReadingsMap);
    AddTurning(from + CRadians::PI, span, readings.scanner_short.last(rays), m_tShortReadingsMap);
    AddTurning(from + CRadians::PI_OVER_TWO, span, readings.scanner_long.first(rays), m_tLongReadingsMap);
    AddTurning(from + CRadians::PI_OVER_TWO + CRadians::PI, span, readings.scanner_long.last(rays),
               m_tLongReadingsMap);
  }

 private:
  void AddTurning(CRadians angle, const CRadians& span, std::span<const sim::ScannerReading> rays,
                  TReadingsMap& map) {
    angle.SignedNormalize();
    for (const sim::ScannerReading& ray : rays) {
      Add(angle, ray, map);
      angle += span;
      angle.SignedNormalize();
    }
  }
  void Empty(TReadingsMap& map) {
    while (!map.empty()) spare_.push_back(map.extract(map.begin()));
  }
  void Add(const CRadians& angle, const sim::ScannerReading& ray, TReadingsMap& map) {
    const double distance = ray.distance < 0.0 ? ray.distance : ray.distance * kCentimetres;
    Insert(angle, distance, map);
    Insert(angle, distance, m_tReadingsMap);
  }
  void Insert(const CRadians& angle, double distance, TReadingsMap& map) {
    if (spare_.empty()) {
      map[angle] = distance;
      return;
    }
    spare_.back().key() = angle;
    spare_.back().mapped() = distance;
    auto result = map.insert(std::move(spare_.back()));
    spare_.pop_back();
    if (result.inserted) return;
    result.position->second = distance;
    spare_.push_back(std::move(result.node));
  }

  const RobotParts& parts_;
  CRadians before_;                             // where it was when it was read last
  std::vector<TReadingsMap::node_type> spare_;  // nodes that were used before
};

template <typename Sensor>
Linked<argos::CCI_Sensor, SensorLink> Make(RobotParts& parts) {
  Sensor* const made = NewDevice<Sensor>(parts);
  return {made, made};
}

}  // namespace

std::span<const SensorRow> SensorRows() {
  static constexpr SensorRow kRows[] = {
      {"battery", {}, Make<Battery>},
      {"colored_blob_omnidirectional_camera", Device::kOmnidirectionalCamera, Make<Camera>},
      {"differential_steering", Device::kWheelEncoders, Make<WheelEncoders>},
      {"footbot_base_ground", Device::kBaseGround, Make<BaseGround>},
      {"footbot_distance_scanner", Device::kDistanceScanner, Make<Scanner>},
      {"footbot_light", Device::kLight, Make<Light>},
      {"footbot_motor_ground", Device::kMotorGround, Make<MotorGround>},
      {"footbot_proximity", Device::kProximity, Make<Proximity>},
      {"footbot_turret_encoder", {}, Make<TurretEncoder>},
      {"footbot_wheel_speed", Device::kWheelEncoders, Make<WheelSpeed>},
      {"ground", Device::kMotorGround | Device::kBaseGround, Make<Ground>},
      {"positioning", Device::kPositioning, Make<Positioning>},
      {"range_and_bearing", Device::kRangeAndBearing, Make<Radio>},
  };
  return kRows;
}

}  // namespace gauntlet::argos_form
