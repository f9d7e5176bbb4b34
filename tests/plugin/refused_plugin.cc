// Plug-ins that must be refused, one for each definition that tests/plugin/CMakeLists.txt makes.
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <vector>

#include "sdk/plugin.h"

namespace {

namespace controllers = gauntlet::controllers;

struct NoSettings {
  double value = 0.0;
};

#if defined(BUILT_IN_NAME)
constexpr const char* kName = "flocking";
#elif defined(TAKEN_NAME)
constexpr const char* kName = "chatty";  // of plugin_of_faults
#else
constexpr const char* kName = "refused";
#endif

#if defined(BAD_RANGE)
constexpr double kLargest = -1.0;
#else
constexpr double kLargest = 1.0;
#endif

#if defined(THROWS_WHEN_LOADED)
const bool kLoaded = [] {
  throw std::runtime_error("no license");
  return true;
}();
#elif defined(EXITS_WHEN_LOADED)
const bool kLoaded = [] {
  std::exit(0);
  return true;
}();
#elif defined(ALLOCATES_WHEN_LOADED)
const bool kLoaded = [] {
  std::vector<std::unique_ptr<char[]>> all;
  while (true) all.emplace_back(new char[std::size_t{64} << 20]);  // untouched: it costs no time
  return true;
}();
#endif

#if defined(MISSING_SYMBOL)
extern "C" void symbol_that_nobody_has();
#endif

std::vector<controllers::ControllerInfo> Rows() {
#if defined(MISSING_SYMBOL)
  symbol_that_nobody_has();
#endif
#if defined(THROWS_IN_LIST)
  throw std::runtime_error("no list today");
#endif
  static const controllers::ParameterTable<NoSettings> table(
      {{"value", "m", 0.5, 0.0, kLargest, controllers::Into<&NoSettings::value>(), "of nothing"}});
  return {controllers::ControllerRow(
      kName, "flocking", "is refused", table,
      +[](const NoSettings&) { return controllers::ControllerFactory{}; })};
}

#if defined(OTHER_ABI) || defined(OTHER_COMPILER)
constexpr gauntlet::sdk::Plugin Changed(std::uint64_t abi, const char* fingerprint) {
  gauntlet::sdk::Plugin plugin = gauntlet::sdk::Exports<Rows, nullptr>::kPlugin;
  plugin.abi = abi;
  plugin.fingerprint = fingerprint;
  return plugin;
}
#endif

}  // namespace

#if defined(OTHER_ABI)
extern "C" __attribute__((visibility("default"))) const gauntlet::sdk::Plugin gauntlet_plugin;
const gauntlet::sdk::Plugin gauntlet_plugin = Changed(gauntlet::sdk::kPluginAbi + 1, "of the future");
#elif defined(OTHER_COMPILER)
extern "C" __attribute__((visibility("default"))) const gauntlet::sdk::Plugin gauntlet_plugin;
const gauntlet::sdk::Plugin gauntlet_plugin = Changed(gauntlet::sdk::kPluginAbi, "arm64 libc++ 14");
#elif defined(WITHOUT_DESCRIPTION)
__attribute__((used)) auto* const kUnused = &Rows;
#else
GAUNTLET_PLUGIN(Rows)
#endif
