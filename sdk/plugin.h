// What a plug-in exports: a shared library that brings controllers and scenarios which this repository does
// not know.
//
//   std::vector<gauntlet::controllers::ControllerInfo> MyControllers();  // its rows
//   GAUNTLET_PLUGIN(MyControllers)
//
// or, with scenarios, and nullptr where there are no controllers:
//
//   std::vector<gauntlet::controllers::ScenarioInfo> MyScenarios();
//   GAUNTLET_SCENARIO_PLUGIN(MyControllers, MyScenarios)
//
// Rows pass as JSON, so that they can gain members: a plug-in that lacks one has its default. The other
// classes of the SDK are C++ and pass between the plug-in and the worker as they are, so both must agree on
// their layout. What the two say about that, kPluginAbi and kPluginFingerprint, is data that a worker
// compares before it calls anything of the plug-in.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/nearest_name.h"
#include "base/result.h"
#include "controllers/behaviour.h"
#include "controllers/rows/plugin_rows.h"
#include "sim/robot/controller.h"
#include "sim/scenario.h"

namespace gauntlet::sdk {

// Changes whenever a header of the SDK changes what compiled code relies on and the sizes below do not tell:
// a virtual function, the meaning of a member or of an enumeration's value.
inline constexpr std::uint32_t kPluginAbi = 4;

// The name of the exported symbol.
inline constexpr const char* kPluginSymbol = "gauntlet_plugin";

// A text that is put together when the program is compiled.
class ConstantText {
 public:
  constexpr void Add(std::string_view text) {
    for (const char c : text) text_[size_++] = c;
  }
  constexpr void Add(std::uint64_t number) {
    if (number >= 10) Add(number / 10);
    text_[size_++] = static_cast<char>('0' + number % 10);
  }
  constexpr const char* c_str() const { return text_.data(); }

 private:
  std::array<char, 512> text_{};  // ends with a zero: what does not fit does not compile
  std::size_t size_ = 0;
};

template <typename... Types>
constexpr void AddSizes(ConstantText& text) {
  (..., (text.Add(" "), text.Add(sizeof(Types))));
}

#if defined(_GLIBCXX_RELEASE) && _GLIBCXX_RELEASE <= 10 && defined(_GLIBCXX_SPAN)
#error "std::span of GCC 10 has another layout than Gauntlet's: put sdk/gcc10 of these headers first (-I)"
#endif

// What C++ code of this standard library and set of headers agrees on. Releases of GCC do not count:
// since GCC 5 libstdc++ keeps its layouts, but for what was new in C++20, which is looked at above.
inline constexpr ConstantText kPluginFingerprint = [] {
  ConstantText text;
#if defined(__x86_64__)
  text.Add("x86-64");
#endif
#if defined(_GLIBCXX_RELEASE)
  text.Add(" libstdc++ strings ");
  text.Add(_GLIBCXX_USE_CXX11_ABI);
#endif
#if defined(_GLIBCXX_DEBUG)
  text.Add(" debug");
#endif
  text.Add(" Eigen ");
  text.Add(EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION);
  text.Add(" aligned ");
  text.Add(EIGEN_MAX_STATIC_ALIGN_BYTES);
  text.Add(" sizes");
  AddSizes<controllers::ControllerContext, controllers::ControllerFactory, Result<std::string>,
           sim::ControlStep, sim::SensorReadings, sim::Actuators, sim::Blob, sim::Message,
           sim::ScannerReading, sim::RandomStream, sim::RunSpec, sim::TestCase, sim::ObstacleGene,
           sim::ArenaRequirements, sim::Arena, sim::Observer, sim::RobotState, sim::RobotSetup, sim::Light,
           sim::RadioBeacon, sim::GroundArea, sim::Interaction, sim::Grippers, sim::Outcome, sim::Annotation>(
      text);
  return text;
}();

// The exported data. The first two members never change their places; others are only ever added behind the
// last, and `size` tells which of them a plug-in has.
struct Plugin {
  std::uint64_t abi;        // kPluginAbi
  const char* fingerprint;  // kPluginFingerprint, as the plug-in was compiled
  std::size_t size;         // of this struct
  // Its rows, as controllers/rows/plugin_rows.h writes them. Error: what is missing in one, or what its list
  // throws.
  Result<std::string> (*rows)();
  // The functions of its rows, by their names; they throw what the rows' own throw.
  controllers::ControllerFactory (*make)(std::string_view controller, const sim::Parameters& resolved);
  sim::ArenaRequirements (*requirements)(std::string_view scenario, const sim::Parameters& parameters,
                                         const sim::TestCase& test_case);
  std::unique_ptr<sim::Scenario> (*create)(std::string_view scenario, const sim::RunSpec& spec,
                                           controllers::ControllerFactory controller);
};

// The rows as JSON, if each has the functions that it needs.
Result<std::string> TellRows(const controllers::PluginRows& rows);

// What a plug-in exports whose rows are these; each list is called once. Either may be nullptr.
template <std::vector<controllers::ControllerInfo> (*kControllers)(),
          std::vector<controllers::ScenarioInfo> (*kScenarios)()>
struct Exports {
  // The rows of one list; what it throws says so.
  template <auto kList>
  static auto List(const char* what) {
    if constexpr (kList == nullptr) {
      return std::invoke_result_t<decltype(kList)>();
    } else {
      try {
        return kList();
      } catch (const std::exception& error) {
        throw std::runtime_error(std::string("its list of ") + what + " throws: " + error.what());
      }
    }
  }
  static const controllers::PluginRows& Rows() {
    static const controllers::PluginRows rows = {List<kControllers>("controllers"),
                                                 List<kScenarios>("scenarios")};
    return rows;
  }
  static Result<std::string> Tell() {
    try {
      return TellRows(Rows());
    } catch (const std::exception& error) {
      return InvalidInput(error.what());
    }
  }
  static controllers::ControllerFactory Make(std::string_view controller, const sim::Parameters& resolved) {
    return FindByName(Rows().controllers, controller)->make(resolved);
  }
  static sim::ArenaRequirements Requirements(std::string_view scenario, const sim::Parameters& parameters,
                                             const sim::TestCase& test_case) {
    return FindByName(Rows().scenarios, scenario)->requirements(parameters, test_case);
  }
  static std::unique_ptr<sim::Scenario> Create(std::string_view scenario, const sim::RunSpec& spec,
                                               controllers::ControllerFactory controller) {
    return FindByName(Rows().scenarios, scenario)->create(spec, std::move(controller));
  }
  static constexpr Plugin kPlugin = {
      kPluginAbi, kPluginFingerprint.c_str(), sizeof(Plugin), Tell, Make, Requirements, Create};
};

}  // namespace gauntlet::sdk

// Once in a plug-in, outside any namespace. `controllers` and `scenarios`: the functions that return its
// rows; nullptr: it brings none.
#define GAUNTLET_SCENARIO_PLUGIN(controllers, scenarios)                                         \
  extern "C" __attribute__((visibility("default"))) const gauntlet::sdk::Plugin gauntlet_plugin; \
  const gauntlet::sdk::Plugin gauntlet_plugin = gauntlet::sdk::Exports<controllers, scenarios>::kPlugin;

// The same of a plug-in that brings controllers alone.
#define GAUNTLET_PLUGIN(controllers) GAUNTLET_SCENARIO_PLUGIN(controllers, nullptr)
