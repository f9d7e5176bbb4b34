#include "tests/integration/shown_campaign.h"

#include <gtest/gtest.h>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {

const TemporaryDirectory& Scratch() {
  static const TemporaryDirectory scratch;
  return scratch;
}

const std::string& Campaign() {
  static const std::string dir = [] {
    const std::string path = Scratch() / "campaign";
    EXPECT_EQ(Gauntlet({"random", "flocking", "--cases", "60", "--dir", path, "--quiet"}).exit_code, 0);
    return path;
  }();
  return dir;
}

}  // namespace gauntlet::testing_support
