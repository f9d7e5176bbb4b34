// What a user defines of the generic scenario beyond its parameters: formulas, and lists of lights and areas.
// It is written in tables of an experiment file ([generic], [[generic.light]] ...), and travels in
// sim::RunSpec::definition as one line for each value: "light.1.x = 1.5".
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/result.h"
#include "controllers/parameters.h"
#include "sim/robot/surroundings.h"

namespace gauntlet::controllers::generic {

// A part of the floor, in m: the disc around (x, y), or without a radius the rectangle.
struct Area {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;
  double length = 0.0;  // along x
  double width = 0.0;   // along y
  double grey = 0.0;    // of the floor, 0 = black, 1 = white

  bool Holds(const sim::Vec2& point) const;
  // Half of what it takes along x and along y.
  sim::Vec2 HalfExtents() const;
};

struct Definition {
  std::string fitness;  // formulas; see formula.h and NamesAtTheEnd
  std::string failure;
  std::string reached;  // NamesAtAMoment; "" = there is nothing to reach
  std::vector<sim::Light> lights;
  std::vector<Area> ground;
  std::vector<Area> sources;
  std::vector<Area> nests;
};

inline constexpr int kMostElements = 100;  // lights, or areas of a kind

// Every value is a number, but for formulas and colours.
using DefinitionValue = std::variant<double, std::string>;
using DefinitionEntry = std::pair<std::string, DefinitionValue>;

// What can be defined, for who lists it.
struct DefinitionKey {
  std::string path;                       // "fitness"; of an element of a list "light.1.x"
  const ParameterInfo* number = nullptr;  // nullptr: a formula
  // What stands for the numbers 0, 1, ...; empty where a number is given.
  std::span<const std::string_view> names = {};
  bool required = false;
};
std::vector<DefinitionKey> DefinitionKeys();

// Takes the values of a definition one by one; of those of one path the last counts.
class DefinitionReader {
 public:
  // Path: "fitness", "light.1.x". Error: what is wrong with the value or the path and what would be right;
  // for the caller to say where it stands.
  Status Set(std::string_view path, const DefinitionValue& value);
  // An element of a list, "light.1", which may keep all its defaults. Errors likewise.
  Status Begin(std::string_view path);
  // Error: what is missing, or contradicts something else.
  Result<Definition> Finish() const;
  // The whole definition, all defaults in it, in the form of RunSpec::definition.
  Result<std::string> Text() const;

 private:
  Status SetInElement(std::string_view path, const DefinitionValue& value);

  std::map<std::string, std::string, std::less<>> formulas_;
  std::map<std::string_view, std::map<int, sim::Parameters>> elements_;  // by table and number
};

// The values in the text of a definition, in its order; for who writes experiments. Error: it is none.
Result<std::vector<DefinitionEntry>> EntriesOf(std::string_view text);
// Reads the text. Errors as DefinitionReader.
Result<Definition> ParseDefinition(std::string_view text);

}  // namespace gauntlet::controllers::generic
