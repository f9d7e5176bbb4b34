// What a user defines of the generic scenario beyond its parameters: formulas, and lists of lights and areas.
// It is written in tables of an experiment file ([generic], [[generic.light]] ...), and travels in
// sim::RunSpec::definition as one line for each value: "light.1.x = 1.5".
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/key.h"
#include "base/result.h"
#include "sim/geometry/vec2.h"
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

inline constexpr std::size_t kMostElements = 100;  // lights, or areas of a kind

// What can be defined, for who lists it: "fitness", and of an element of a list "light.1.x". Formulas are
// texts.
std::vector<KeyInfo> DefinitionKeys();

// A path and its value: a number, but for formulas and colours, which are texts. A formula may be a number.
using DefinitionEntry = std::pair<std::string, KeyValue>;

// Takes the values of a definition one by one; of those of one path the last counts.
class DefinitionReader {
 public:
  // Path: "fitness", "light.1.x". Error: what is wrong with the value or the path and what would be right;
  // for the caller to say where it stands.
  Status Set(std::string_view path, const KeyValue& value);
  // An element of a list, "light.1", which may keep all its defaults. Errors likewise.
  Status Begin(std::string_view path);
  // Error: what is missing, or contradicts something else.
  Result<Definition> Finish() const;
  // The whole definition, all defaults in it, in the form of RunSpec::definition.
  Result<std::string> Text() const;

 private:
  Definition definition_;
  std::map<std::string, std::set<std::size_t>> begun_;  // by list, the numbers of its elements
};

// The values in the text of a definition, in its order; for who writes experiments. Error: it is none.
Result<std::vector<DefinitionEntry>> EntriesOf(std::string_view text);
// Reads the text. Errors as DefinitionReader.
Result<Definition> ParseDefinition(std::string_view text);

}  // namespace gauntlet::controllers::generic
