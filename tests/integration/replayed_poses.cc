#include "tests/integration/replayed_poses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <sstream>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {

Poses ShownPoses(Browser& browser) {
  const nlohmann::json transforms = browser.Evaluate(
      "[...document.querySelectorAll('.page.shown .robot')].map(r => r.getAttribute('transform'))");
  Poses poses;
  for (const std::string transform : transforms) {
    std::array<double, 3>& pose = poses.emplace_back();
    EXPECT_EQ(std::sscanf(transform.c_str(), "translate(%lf %lf) rotate(%lf)", &pose[0], &pose[1], &pose[2]),
              3)
        << transform;
  }
  return poses;
}

bool PlayToTheEnd(Browser& browser) {
  browser.Evaluate(
      "(() => { const page = document.querySelector('.page.shown'); "
      "const [speed] = page.querySelectorAll('.controls select'); speed.value = '64'; "
      "page.querySelector('.controls button').click(); })()");
  return browser.Becomes(
      "(() => { const slider = document.querySelector('.page.shown input[type=range]'); "
      "return slider.value === slider.max && "
      "document.querySelector('.page.shown .controls button').textContent === 'Play'; })()");
}

Poses LastPoses(const std::string& campaign, const std::string& run) {
  const TemporaryDirectory scratch;
  const std::string csv = scratch / "run.csv";
  EXPECT_EQ(Gauntlet({"replay", campaign, run, "--csv", csv}).exit_code, 0);
  std::istringstream lines(ReadFile(csv));
  Poses poses;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    int tick = 0;
    double time = 0;
    std::size_t robot = 0;
    std::array<double, 3> pose{};
    EXPECT_EQ(std::sscanf(line.c_str(), "%d,%lf,%zu,%lf,%lf,%lf", &tick, &time, &robot, &pose[0], &pose[1],
                          &pose[2]),
              6);
    pose[2] *= 180.0 / M_PI;
    if (robot >= poses.size()) poses.resize(robot + 1);
    poses[robot] = pose;
  }
  return poses;
}

}  // namespace gauntlet::testing_support
