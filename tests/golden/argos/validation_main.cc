// Prints how far this simulator is from ARGoS, quantity by quantity: sensors, motion, contacts. Exit code 1
// when a tolerance is broken.
#include <cstdio>

#include "tests/golden/argos/motion_validation.h"
#include "tests/golden/argos/sensor_validation.h"

namespace {

// Whether all hold.
bool Print(const std::string& name, const std::vector<gauntlet::ValidationRow>& rows) {
  if (rows.empty()) std::printf("| %s | missing | | | | | FAILED |\n", name.c_str());
  bool ok = !rows.empty();
  for (const gauntlet::ValidationRow& row : rows) {
    std::printf("| %s | %s | %d | %d | %.1e | %.1e | %s |\n", row.file.c_str(), row.quantity.c_str(),
                row.values, row.edges, row.tolerance, row.error, row.ok() ? "ok" : "FAILED");
    ok = ok && row.ok();
  }
  return ok;
}

}  // namespace

int main() {
  bool ok = true;
  std::printf("| file | quantity | values | left out at edges | tolerance | largest error | |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const std::string& file : gauntlet::SensorSweeps())
    ok = Print(file, gauntlet::ValidateSensorSweep(file)) && ok;
  for (const std::string& scene : gauntlet::MotionScenes())
    ok = Print(scene, gauntlet::ValidateMotion(scene)) && ok;
  return ok ? 0 : 1;
}
