#include "tests/golden/argos/sensor_validation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "sim/sensors/distance_scanner.h"
#include "sim/sensors/ground_sensor.h"
#include "sim/sensors/light_sensor.h"
#include "sim/sensors/proximity.h"
#include "sim/sensors/sensor_table.h"
#include "tests/sim/sensors/sensing.h"
#include "tests/support/make_box.h"
#include "tests/support/paths.h"

namespace gauntlet {
namespace {

using sim::BodyFrame;
using sim::Color;
using sim::kDegree;
using sim::kPi;
using sim::Vec2;

constexpr double kTolerance = 1e-3;  // of full scale

class Sweep {
 public:
  explicit Sweep(const std::string& name) : name_("sensors/" + name) {
    std::ifstream file(std::string(GAUNTLET_SOURCE_DIR) + "/tests/golden/argos/" + name_);
    std::string line;
    while (std::getline(file, line)) {
      std::istringstream cells(line);
      std::vector<std::string> row;
      for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
      if (columns_.empty()) {
        for (const std::string& column : row) columns_.emplace(column, columns_.size());
      } else {
        row.resize(columns_.size());
        rows_.push_back(std::move(row));
      }
    }
  }
  const std::string& name() const { return name_; }
  std::size_t size() const { return rows_.size(); }
  bool Has(const std::string& column) const { return columns_.contains(column); }
  const std::string& Text(std::size_t row, const std::string& column) const {
    return rows_[row][columns_.at(column)];
  }
  double Number(std::size_t row, const std::string& column) const {
    return std::strtod(Text(row, column).c_str(), nullptr);
  }

 private:
  std::string name_;
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

using Reading = std::function<double(std::size_t row)>;

// Whether two rows belong to the same series of the sweep.
bool SameSeries(const Sweep& sweep, std::size_t a, std::size_t b) {
  return !sweep.Has("occluder") || sweep.Text(a, "occluder") == sweep.Text(b, "occluder");
}

// Compares one column with our readings. A value that is off but was measured one step of the sweep before or
// after stands at an edge.
void Compare(const Sweep& sweep, const std::string& column, double full_scale, const Reading& ours,
             ValidationRow& result) {
  for (std::size_t row = 0; row < sweep.size(); ++row) {
    const double reading = ours(row);
    const auto error = [&](std::size_t at) {
      return std::abs(reading - sweep.Number(at, column)) / full_scale;
    };
    ++result.values;
    const auto fits = [&](std::size_t at) {
      return SameSeries(sweep, row, at) && error(at) <= result.tolerance;
    };
    const bool near_edge = (row > 0 && fits(row - 1)) || (row + 1 < sweep.size() && fits(row + 1));
    if (error(row) > result.tolerance && near_edge) {
      ++result.edges;
    } else {
      result.error = std::max(result.error, error(row));
    }
  }
}

ValidationRow Share(const Sweep& sweep, const std::string& quantity) {
  return {.file = sweep.name(), .quantity = quantity, .tolerance = kTolerance};
}

ValidationRow Count(const Sweep& sweep, const std::string& quantity) {
  return {.file = sweep.name(), .quantity = quantity, .tolerance = 0.0};
}

BodyFrame At(double x, double y, double heading_deg = 0.0) {
  return BodyFrame(sim::Pose{{x, y}, sim::WrapAngle(heading_deg * kDegree)});
}

// What stands between in the *_occ sweeps: a robot, or a box of 0.1 x 0.1 m.
void PlaceOccluder(const std::string& kind, const Vec2& place, std::vector<BodyFrame>& robots,
                   sim::Occluders& occluders) {
  if (kind == "robot") robots.push_back(At(place.x(), place.y()));
  if (kind == "box_1.0m") occluders.AddBox(sim::MakeBox(place, 0.1, 0.1, 0.0), 1.0);
  if (kind == "box_0.2m") occluders.AddBox(sim::MakeBox(place, 0.1, 0.1, 0.0), 0.2);
}

std::vector<ValidationRow> Proximity(const Sweep& sweep, bool wall) {
  ValidationRow result = Share(sweep, "24 readings, of 1");
  for (std::size_t sensor = 0; sensor < sim::foot_bot::kProximitySensors; ++sensor) {
    Compare(
        sweep, "s" + std::to_string(sensor), 1.0,
        [&](std::size_t row) {
          const double gap = sweep.Number(row, "gap_m");
          if (wall) {
            const BodyFrame self = At(-sim::foot_bot::kRadius - gap, 0.0, sweep.Number(row, "heading_deg"));
            sim::ProximityRing ring(self);
            ring.See(sim::MakeBox({0.1, 0.0}, 0.2, 6.0, 0.0));
            return sim::ReadingsOf(ring)[sensor];
          }
          const BodyFrame self = At(0.0, 0.0, sweep.Number(row, "self_heading_deg"));
          sim::ProximityRing ring(self);
          ring.See(At(2.0 * sim::foot_bot::kRadius + gap, 0.0, sweep.Number(row, "other_heading_deg")));
          return sim::ReadingsOf(ring)[sensor];
        },
        result);
  }
  return {result};
}

struct CameraScene {
  std::vector<BodyFrame> robots;  // 0 looks, 1 is looked at
  sim::Occluders occluders;
  sim::Signals target;
  std::vector<sim::Light> lights;
  double aperture_deg = 80.0;
};

std::vector<sim::Blob> Look(const CameraScene& scene) {
  const double aperture = scene.aperture_deg * kDegree;
  const double range = sim::foot_bot::kCameraHeight * sim::Sin(aperture) / sim::Cos(aperture);
  sim::SensingPlace place;
  place.robots = scene.robots;
  place.occluders = scene.occluders;
  place.lamps = scene.lights;
  place.signals.resize(scene.robots.size());
  place.signals[1] = scene.target;
  place.sensors.resize(scene.robots.size());
  place.sensors[0] = {.devices = sim::Device::kOmnidirectionalCamera, .camera_range = range};
  std::vector<std::vector<sim::Blob>> seen;
  place.Read(sim::MakeOmniCameras, [&](const sim::SensorReadings& readings) {
    seen.emplace_back(readings.blobs.begin(), readings.blobs.end());
  });
  return seen[0];
}

double CountOf(const std::vector<sim::Blob>& blobs, Color color) {
  return static_cast<double>(
      std::count_if(blobs.begin(), blobs.end(), [&](const sim::Blob& blob) { return blob.color == color; }));
}

std::vector<ValidationRow> Camera(const Sweep& sweep, const std::string& file) {
  std::vector<std::vector<sim::Blob>> seen;
  const double aperture_deg = file.find("70") != std::string::npos ? 70.0 : 80.0;
  for (std::size_t row = 0; row < sweep.size(); ++row) {
    CameraScene scene;
    scene.aperture_deg = aperture_deg;
    scene.robots = {At(0.0, 0.0), At(sweep.Number(row, "dx_m"), sweep.Number(row, "dy_m"))};
    if (file.find("ring") != std::string::npos) {
      scene.target.ring.fill(Color::kGreen);
    } else {
      scene.target.beacon = Color::kRed;
    }
    if (file.find("light") != std::string::npos) {
      scene.lights = {{.position = {0.6, 0.1}, .height = 0.5, .intensity = 3.0, .color = Color::kYellow}};
    }
    seen.push_back(Look(scene));
  }
  std::vector<ValidationRow> results;
  for (const auto& [column, color] : {std::pair("n_red", Color::kRed), std::pair("n_green", Color::kGreen),
                                      std::pair("n_yellow", Color::kYellow)}) {
    results.push_back(Count(sweep, std::string(column) + ", blobs"));
    const Color wanted = color;
    Compare(
        sweep, column, 1.0, [&](std::size_t row) { return CountOf(seen[row], wanted); }, results.back());
  }
  // ARGoS reports the blobs in an order of its own: its first must be one of ours, within 5 mm.
  ValidationRow range = Share(sweep, "distance of the first blob, of the half side");
  ValidationRow bearing = Share(sweep, "bearing of the first blob, of 180 degrees");
  const double half_side = aperture_deg == 70.0 ? 0.7932 : 1.6373;
  for (std::size_t row = 0; row < sweep.size(); ++row) {
    const double argos_range = sweep.Number(row, "first_dist_cm") / 100.0;
    if (argos_range < 0.0 || seen[row].empty()) continue;
    const double argos_bearing = sweep.Number(row, "first_angle_deg") * kDegree;
    const Vec2 argos = argos_range * sim::UnitVector(argos_bearing);
    const sim::Blob& match =
        *std::min_element(seen[row].begin(), seen[row].end(), [&](const sim::Blob& a, const sim::Blob& b) {
          return (a.position - argos).norm() < (b.position - argos).norm();
        });
    ++range.values;
    ++bearing.values;
    range.error = std::max(range.error, std::abs(match.range - argos_range) / half_side);
    bearing.error = std::max(bearing.error, std::abs(sim::WrapAngle(match.Bearing() - argos_bearing)) / kPi);
  }
  results.push_back(range);
  results.push_back(bearing);
  return results;
}

std::vector<ValidationRow> CameraOcclusion(const Sweep& sweep) {
  std::vector<ValidationRow> results;
  for (const auto& [column, color] : {std::pair("n_red", Color::kRed), std::pair("n_green", Color::kGreen)}) {
    results.push_back(Count(sweep, std::string(column) + ", blobs"));
    const Color wanted = color;
    Compare(
        sweep, column, 1.0,
        [&](std::size_t row) {
          CameraScene scene;
          scene.robots = {At(0.0, 0.0), At(sweep.Number(row, "target_dist_m"), 0.0)};
          scene.target.beacon = Color::kRed;
          scene.target.ring.fill(Color::kGreen);
          PlaceOccluder(sweep.Text(row, "occluder"),
                        {sweep.Number(row, "occluder_x_m"), sweep.Number(row, "occluder_y_m")}, scene.robots,
                        scene.occluders);
          return CountOf(Look(scene), wanted);
        },
        results.back());
  }
  return results;
}

// What robot 0 hears of robot 1.
std::vector<sim::Message> Hear(const std::vector<BodyFrame>& robots, const sim::Occluders& occluders) {
  sim::SensingPlace place;
  place.robots = robots;
  place.occluders = occluders;
  place.sensors.resize(robots.size());
  for (std::size_t i = 0; i < 2; ++i) {
    place.sensors[i] = {.devices = sim::Device::kRangeAndBearing, .radio_range = 3.0};
  }
  std::vector<std::vector<sim::Message>> heard;
  place.Read(sim::MakeRadios, [&](const sim::SensorReadings& readings) {
    heard.emplace_back(readings.range_and_bearing.begin(), readings.range_and_bearing.end());
  });
  return heard[0];
}

std::vector<ValidationRow> RangeAndBearing(const Sweep& sweep) {
  ValidationRow count = Count(sweep, "n_msgs, messages");
  ValidationRow range = Share(sweep, "range, of 3 m");
  ValidationRow bearing = Share(sweep, "bearing, of 180 degrees");
  const auto heard = [&](std::size_t row) {
    const Vec2 place =
        sweep.Number(row, "dist_m") * sim::UnitVector(sweep.Number(row, "angle_deg") * kDegree);
    return Hear({At(0.0, 0.0), At(place.x(), place.y())}, {});
  };
  const auto first = [&](std::size_t row) {
    const auto messages = heard(row);
    return messages.empty() ? sim::Message{} : messages[0];
  };
  Compare(
      sweep, "n_msgs", 1.0, [&](std::size_t row) { return static_cast<double>(heard(row).size()); }, count);
  Compare(
      sweep, "range_cm", 300.0, [&](std::size_t row) { return 100.0 * first(row).range; }, range);
  Compare(
      sweep, "hbearing_deg", 180.0, [&](std::size_t row) { return first(row).Bearing() / kDegree; }, bearing);
  return {count, range, bearing};
}

std::vector<ValidationRow> RangeAndBearingOcclusion(const Sweep& sweep) {
  ValidationRow count = Count(sweep, "n_msgs, messages");
  Compare(
      sweep, "n_msgs", 1.0,
      [&](std::size_t row) {
        std::vector<BodyFrame> robots = {At(0.0, 0.0), At(sweep.Number(row, "dist_m"), 0.0)};
        sim::Occluders occluders;
        PlaceOccluder(sweep.Text(row, "occluder"),
                      {sweep.Number(row, "occluder_x_m"), sweep.Number(row, "occluder_y_m")}, robots,
                      occluders);
        return static_cast<double>(Hear(robots, occluders).size());
      },
      count);
  return {count};
}

const std::vector<sim::Light>& Lamp() {
  static const std::vector<sim::Light> lamp = {{.position = {0.0, 0.0}, .height = 0.5, .intensity = 3.0}};
  return lamp;
}

std::vector<ValidationRow> Light(const Sweep& sweep) {
  ValidationRow result = Share(sweep, "24 readings, of 1");
  for (std::size_t sensor = 0; sensor < sim::foot_bot::kLightSensors; ++sensor) {
    Compare(
        sweep, "s" + std::to_string(sensor), 1.0,
        [&](std::size_t row) {
          const std::vector<BodyFrame> robots = {
              At(-sweep.Number(row, "dist_m"), 0.0, -sweep.Number(row, "bearing_deg"))};
          return sim::SenseLight(robots, 0, Lamp(), {})[sensor];
        },
        result);
  }
  return {result};
}

std::vector<ValidationRow> LightOcclusion(const Sweep& sweep) {
  ValidationRow result = Share(sweep, "largest reading, of 1");
  Compare(
      sweep, "max_reading", 1.0,
      [&](std::size_t row) {
        const double start = -sweep.Number(row, "light_dist_m");
        std::vector<BodyFrame> robots = {At(start, 0.0)};
        sim::Occluders occluders;
        PlaceOccluder(sweep.Text(row, "occluder"),
                      {start + sweep.Number(row, "occluder_x_m"), sweep.Number(row, "occluder_y_m")}, robots,
                      occluders);
        const sim::LightReadings readings = sim::SenseLight(robots, 0, Lamp(), occluders);
        return *std::max_element(readings.begin(), readings.end());
      },
      result);
  return {result};
}

class HalfBlackFloor final : public sim::Surroundings {
 public:
  double FloorGrey(const Vec2& point) const override { return point.x() > 0.0 ? 0.0 : 1.0; }
};

std::vector<ValidationRow> Ground(const Sweep& sweep) {
  const HalfBlackFloor floor;
  ValidationRow motor = Share(sweep, "4 motor ground readings, of 1");
  ValidationRow base = Share(sweep, "8 base ground readings, of 1");
  const auto self = [&](std::size_t row) {
    return At(sweep.Number(row, "x_m"), 0.0, sweep.Number(row, "heading_deg"));
  };
  for (std::size_t i = 0; i < sim::kMotorGroundPlaces.size(); ++i) {
    Compare(
        sweep, "mg" + std::to_string(i), 1.0,
        [&](std::size_t row) { return sim::SenseGround(self(row), sim::kMotorGroundPlaces, floor)[i]; },
        motor);
  }
  for (std::size_t i = 0; i < sim::kBaseGroundPlaces.size(); ++i) {
    Compare(
        sweep, "bg" + std::to_string(i), 1.0,
        [&](std::size_t row) { return sim::SenseGround(self(row), sim::kBaseGroundPlaces, floor)[i]; }, base);
  }
  return {motor, base};
}

// Matched by angle, because ARGoS lists the rays of a tick by angle.
std::vector<ValidationRow> Scanner(const Sweep& sweep) {
  const std::vector<BodyFrame> robots = {At(0.0, 0.0)};
  const std::vector<sim::OrientedBox> boxes = {sim::MakeBox({0.3, 0.0}, 0.1, 0.6, 0.0),
                                               sim::MakeBox({0.0, 1.0}, 0.6, 0.1, 0.0),
                                               sim::MakeBox({0.0, -0.2}, 0.6, 0.1, 0.0)};
  sim::DistanceScanner scanner;
  int tick = 0;
  ValidationRow bearing = Share(sweep, "ray bearing, of 180 degrees");
  ValidationRow near = Share(sweep, "short range reading, of 0.26 m");
  ValidationRow far = Share(sweep, "long range reading, of 1.42 m");
  for (std::size_t row = 0; row < sweep.size(); ++row) {
    for (; tick < static_cast<int>(sweep.Number(row, "tick")); ++tick) {
      scanner.Scan({.mode = sim::ScannerCommand::Mode::kSpeed, .value = kPi}, robots, 0, boxes);
    }
    const bool is_short = sweep.Text(row, "kind") == "short";
    const auto rays = is_short ? scanner.short_range() : scanner.long_range();
    const double angle = sweep.Number(row, "angle_deg") * kDegree;
    const auto off = [&](const sim::ScannerReading& ray) {
      return std::abs(sim::WrapAngle(ray.bearing - angle));
    };
    const sim::ScannerReading& ray = *std::min_element(
        rays.begin(), rays.end(), [&](const auto& a, const auto& b) { return off(a) < off(b); });
    ValidationRow& result = is_short ? near : far;
    const double full_scale = is_short ? 0.26 : 1.42;
    const double argos = sweep.Number(row, "reading_cm");
    // Codes are told apart from distances.
    const double ours = ray.distance < 0.0 ? ray.distance : 100.0 * ray.distance;
    ++bearing.values;
    ++result.values;
    bearing.error = std::max(bearing.error, off(ray) / kPi);
    result.error = std::max(result.error, std::abs(ours - argos) / (100.0 * full_scale));
  }
  return {bearing, near, far};
}

}  // namespace

std::vector<std::string> SensorSweeps() {
  return {"prox_wall.csv",   "prox_robot.csv",  "light.csv",        "light_occ.csv",     "ground.csv",
          "scan.csv",        "rab.csv",         "rab_occ.csv",      "cam_beacon_70.csv", "cam_beacon_80.csv",
          "cam_ring_70.csv", "cam_ring_80.csv", "cam_light_70.csv", "cam_light_80.csv",  "cam_occ_80.csv"};
}

std::vector<ValidationRow> ValidateSensorSweep(const std::string& file) {
  const Sweep sweep(file);
  if (sweep.size() == 0) return {};
  if (file == "prox_wall.csv") return Proximity(sweep, true);
  if (file == "prox_robot.csv") return Proximity(sweep, false);
  if (file == "light.csv") return Light(sweep);
  if (file == "light_occ.csv") return LightOcclusion(sweep);
  if (file == "ground.csv") return Ground(sweep);
  if (file == "scan.csv") return Scanner(sweep);
  if (file == "rab.csv") return RangeAndBearing(sweep);
  if (file == "rab_occ.csv") return RangeAndBearingOcclusion(sweep);
  if (file == "cam_occ_80.csv") return CameraOcclusion(sweep);
  return Camera(sweep, file);
}

}  // namespace gauntlet
