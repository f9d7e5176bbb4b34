// Robots' poses at the end of a run: in the replay that a browser shows, and simulated again.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/integration/browser.h"

namespace gauntlet::testing_support {

// x and y in metres, heading in degrees; of each robot.
using Poses = std::vector<std::array<double, 3>>;

// In the replay on the page that is shown.
Poses ShownPoses(Browser& browser);
// Presses its button at the highest speed and waits for the end; false at the deadline.
bool PlayToTheEnd(Browser& browser);
// At the end of the campaign's run, as `gauntlet replay` has it.
Poses LastPoses(const std::string& campaign, const std::string& run);

}  // namespace gauntlet::testing_support
