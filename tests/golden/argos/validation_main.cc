// Prints how far this simulator is from ARGoS, quantity by quantity. Exit code 1 when a tolerance is broken.
#include <cstdio>

#include "tests/golden/argos/sensor_validation.h"

int main() {
  bool all_ok = true;
  std::printf("| file | quantity | values | left out at edges | tolerance | largest error | |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const std::string& file : gauntlet::SensorSweeps()) {
    const std::vector<gauntlet::ValidationRow> rows = gauntlet::ValidateSensorSweep(file);
    if (rows.empty()) {
      std::printf("| %s | missing | | | | | FAILED |\n", file.c_str());
      all_ok = false;
    }
    for (const gauntlet::ValidationRow& row : rows) {
      std::printf("| %s | %s | %d | %d | %.1e | %.1e | %s |\n", row.file.c_str(), row.quantity.c_str(),
                  row.values, row.edges, row.tolerance, row.error, row.ok() ? "ok" : "FAILED");
      all_ok = all_ok && row.ok();
    }
  }
  return all_ok ? 0 : 1;
}
