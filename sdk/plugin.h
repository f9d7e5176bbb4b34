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
// The classes and tables of the SDK are C++ and pass between the plug-in and the worker as they are, so both
// must agree on their layout. What the two say about that, kPluginAbi and kPluginFingerprint, is data that a
// worker compares before it calls anything of the plug-in.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "controllers/behaviour.h"
#include "sim/robot/controller.h"
#include "sim/scenario.h"

namespace gauntlet::sdk {

// Changes whenever a header of the SDK changes what compiled code relies on and the sizes below do not tell:
// a virtual function, the meaning of a member or of an enumeration's value.
inline constexpr std::uint32_t kPluginAbi = 3;

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

// What C++ code of this compiler, standard library and set of headers agrees on.
inline constexpr ConstantText kPluginFingerprint = [] {
  ConstantText text;
#if defined(__x86_64__)
  text.Add("x86-64");
#endif
#if defined(_GLIBCXX_RELEASE)
  text.Add(" libstdc++ ");
  text.Add(_GLIBCXX_RELEASE);
  text.Add(" strings ");
  text.Add(_GLIBCXX_USE_CXX11_ABI);
#endif
#if defined(_GLIBCXX_DEBUG)
  text.Add(" debug");
#endif
  text.Add(" C++ ");
  text.Add(__cplusplus);
  text.Add(" Eigen ");
  text.Add(EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION);
  text.Add(" aligned ");
  text.Add(EIGEN_MAX_STATIC_ALIGN_BYTES);
  text.Add(" sizes");
  AddSizes<controllers::ControllerInfo, controllers::ControllerContext, controllers::ControllerFactory,
           controllers::ParameterInfo, sim::ControlStep, sim::SensorReadings, sim::Actuators, sim::Blob,
           sim::Message, sim::ScannerReading, sim::RandomStream, controllers::ScenarioInfo,
           controllers::MetricInfo, controllers::FailureType, controllers::FailureKind,
           controllers::DescriptorAxis, sim::RunStyle, sim::AnnotationStyle, sim::RunSpec, sim::TestCase,
           sim::ObstacleGene, sim::ArenaRequirements, sim::Arena, sim::Observer, sim::RobotState,
           sim::RobotSetup, sim::Light, sim::RadioBeacon, sim::GroundArea, sim::Interaction, sim::Grippers,
           sim::Outcome, sim::Annotation>(text);
  return text;
}();

// The exported data. The first two members never change their places.
struct Plugin {
  std::uint64_t abi;        // kPluginAbi
  const char* fingerprint;  // kPluginFingerprint, as the plug-in was compiled
  // Its controllers and its scenarios, nullptr where it brings none; each is called once. What the rows refer
  // to lives as long as the library is loaded.
  std::vector<controllers::ControllerInfo> (*controllers)();
  std::vector<controllers::ScenarioInfo> (*scenarios)();
};

}  // namespace gauntlet::sdk

// Once in a plug-in, outside any namespace. `controllers` and `scenarios`: the functions that return its
// rows; nullptr: it brings none.
#define GAUNTLET_SCENARIO_PLUGIN(controllers, scenarios)                                         \
  extern "C" __attribute__((visibility("default"))) const gauntlet::sdk::Plugin gauntlet_plugin; \
  const gauntlet::sdk::Plugin gauntlet_plugin = {                                                \
      gauntlet::sdk::kPluginAbi, gauntlet::sdk::kPluginFingerprint.c_str(), controllers, scenarios};

// The same of a plug-in that brings controllers alone.
#define GAUNTLET_PLUGIN(controllers) GAUNTLET_SCENARIO_PLUGIN(controllers, nullptr)
