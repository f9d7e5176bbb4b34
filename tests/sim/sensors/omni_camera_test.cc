#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/sim/argos_csv.h"
#include "tests/sim/sensors/sensing.h"

namespace gauntlet::sim {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

// Half side of the square seen with the given aperture: camera height * tan(aperture).
double RangeOf(double aperture_deg) {
  return foot_bot::kCameraHeight * Sin(aperture_deg * kDegree) / Cos(aperture_deg * kDegree);
}

BodyFrame FrameAt(double x, double y, double heading = 0.0) {
  return BodyFrame(Pose{{x, y}, heading});
}

Arena ArenaWith(const Genome& obstacles) {
  TestCase test_case;
  test_case.obstacles = obstacles;
  return Arena(test_case);
}

struct Seen {
  std::vector<std::vector<Blob>> blobs;  // per robot
};

Seen Look(const Arena& arena, const std::vector<BodyFrame>& robots, const std::vector<Color>& beacons,
          const std::vector<double>& ranges) {
  SensingPlace place;
  place.robots = robots;
  place.occluders = Occluders(arena);
  for (const Color beacon : beacons) place.signals.push_back({.beacon = beacon});
  for (const double range : ranges) {
    place.sensors.push_back({.devices = Device::kOmnidirectionalCamera, .camera_range = range});
  }
  Seen seen;
  place.Read(MakeOmniCameras, [&](const SensorReadings& readings) {
    seen.blobs.emplace_back(readings.blobs.begin(), readings.blobs.end());
  });
  return seen;
}

void CompareSweep(const std::string& file, double aperture_deg) {
  const CsvTable table = ReadArgosCsv("sensors/" + file);
  const Arena arena = ArenaWith({});
  const double range = RangeOf(aperture_deg);
  int visible = 0;
  double range_error = 0.0;
  double bearing_error = 0.0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double dx = table.At(row, "dx_m");
    const double dy = table.At(row, "dy_m");
    const Seen seen =
        Look(arena, {FrameAt(0, 0), FrameAt(dx, dy)}, {Color::kBlack, Color::kRed}, {range, 0.0});
    ASSERT_EQ(seen.blobs[0].size(), table.At(row, "n_red")) << "dx " << dx << " dy " << dy;
    if (seen.blobs[0].empty()) continue;
    ++visible;
    range_error =
        std::max(range_error, std::abs(seen.blobs[0][0].range - table.At(row, "first_dist_cm") / 100.0));
    bearing_error = std::max(
        bearing_error, std::abs(seen.blobs[0][0].Bearing() / kDegree - table.At(row, "first_angle_deg")));
  }
  std::printf("%s: %d of %zu places seen, as in ARGoS; largest errors %.1e m, %.1e degrees\n", file.c_str(),
              visible, table.rows.size(), range_error, bearing_error);
  EXPECT_GT(visible, 100);
  EXPECT_LT(range_error, 1e-5);
  EXPECT_LT(bearing_error, 1e-3);
}

TEST(OmniCameras, SeeWhatArgosSeesWithAperture70) {
  CompareSweep("cam_beacon_70.csv", 70.0);
}
TEST(OmniCameras, SeeWhatArgosSeesWithAperture80) {
  CompareSweep("cam_beacon_80.csv", 80.0);
}

TEST(OmniCameras, MeasureBearingFromTheHeading) {
  const Seen seen = Look(ArenaWith({}), {FrameAt(0, 0, kPi / 2), FrameAt(0.5, 0, kPi)},
                         {Color::kBlue, Color::kRed}, {1.6, 1.6});
  ASSERT_EQ(seen.blobs[0].size(), 1u);
  EXPECT_NEAR(seen.blobs[0][0].Bearing(), -kPi / 2, 1e-12);
  EXPECT_EQ(seen.blobs[0][0].color, Color::kRed);
  ASSERT_EQ(seen.blobs[1].size(), 1u);
  EXPECT_NEAR(seen.blobs[1][0].Bearing(), 0.0, 1e-12);
  EXPECT_EQ(seen.blobs[1][0].color, Color::kBlue);
}

TEST(OmniCameras, ReportBlobsInRobotOrderAndNotThemselves) {
  const Seen seen = Look(ArenaWith({}), {FrameAt(0, 0), FrameAt(0.5, 0), FrameAt(0.2, 0)},
                         {Color::kRed, Color::kGreen, Color::kBlue}, {1.6, 1.6, 1.6});
  EXPECT_THAT(seen.blobs[1],
              ElementsAre(Field(&Blob::color, Color::kRed), Field(&Blob::color, Color::kBlue)));
  EXPECT_THAT(seen.blobs[2],
              ElementsAre(Field(&Blob::color, Color::kRed), Field(&Blob::color, Color::kGreen)));
}

TEST(OmniCameras, DoNotSeeBlackBeacons) {
  const Seen seen =
      Look(ArenaWith({}), {FrameAt(0, 0), FrameAt(0.5, 0)}, {Color::kRed, Color::kBlack}, {1.6, 1.6});
  EXPECT_THAT(seen.blobs[0], IsEmpty());
  EXPECT_EQ(seen.blobs[1].size(), 1u);
}

TEST(OmniCameras, RangeBelongsToTheViewer) {
  const Seen seen =
      Look(ArenaWith({}), {FrameAt(0, 0), FrameAt(1.0, 0)}, {Color::kRed, Color::kRed}, {1.6, 0.8});
  EXPECT_EQ(seen.blobs[0].size(), 1u);
  EXPECT_THAT(seen.blobs[1], IsEmpty());
}

TEST(OmniCameras, ObstaclesHideBeaconsRobotsDoNot) {
  const Arena arena = ArenaWith({{.x = 0.5, .y = 0.0, .length = 0.4, .width = 0.1, .orientation_deg = 90.0}});
  const Seen behind = Look(arena, {FrameAt(0, 0), FrameAt(1.0, 0)}, {Color::kRed, Color::kRed}, {1.6, 1.6});
  EXPECT_THAT(behind.blobs[0], IsEmpty());
  EXPECT_THAT(behind.blobs[1], IsEmpty());
  const Seen past =
      Look(arena, {FrameAt(0, 0.25), FrameAt(1.0, 0.25)}, {Color::kRed, Color::kRed}, {1.6, 1.6});
  EXPECT_EQ(past.blobs[0].size(), 1u);
  const Seen over_a_robot = Look(ArenaWith({}), {FrameAt(0, 0), FrameAt(1.0, 0), FrameAt(0.5, 0)},
                                 {Color::kRed, Color::kRed, Color::kBlack}, {1.6, 1.6, 1.6});
  EXPECT_EQ(over_a_robot.blobs[0].size(), 1u);
}

}  // namespace
}  // namespace gauntlet::sim
