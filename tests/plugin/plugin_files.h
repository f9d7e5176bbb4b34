// The plug-ins that tests/plugin/CMakeLists.txt makes, and campaigns with them.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "base/system/sha256.h"
#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {

// "twins": the path of its library.
inline std::string PluginPath(const std::string& name) {
  return std::string(GAUNTLET_PLUGINS) + "/libplugin_" + name + ".so";
}

// Of light flocking by the twin from twins.so in `scratch`, a copy of the library; what a campaign says of it
// must be what it says of the built-in one.
inline SmallCampaign SmallPlugin(const TemporaryDirectory& scratch) {
  std::filesystem::copy_file(PluginPath("of_twins"), scratch / "twins.so");
  const std::string file = scratch / "twins.toml";
  std::ofstream(file) << "scenario = 'light-flocking'\ncontroller = 'twin'\nplugins = ['twins.so']\n";
  SmallCampaign campaign;
  campaign.name = "plugin";
  campaign.experiment = file;
  campaign.settings = {"scenario_parameters.time_limit=20"};
  return campaign;
}

}  // namespace gauntlet::testing_support
