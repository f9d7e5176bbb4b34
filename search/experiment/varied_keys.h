// What varies in a search over settings: keys of an experiment, and the range or the values of each. Where
// values are drawn, a key has a distribution over them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment.h"
#include "search/experiment/schema.h"

namespace gauntlet {

// One number from 0 to 1 for each key that varies: where its value stands in its range, or in its list.
using SettingsPoint = std::vector<double>;

struct VariedKey {
  Key key;
  double low = 0.0;  // of numbers, ends included
  double high = 0.0;
  bool log = false;     // even on the logarithmic scale
  bool normal = false;  // around the middle, with the ends at two standard deviations, and cut there
  double step = 0.0;    // of the grid that values lie on; 0 = none
  std::vector<KeyValue> values = {};  // of flags and choices, instead of a range
  std::vector<double> weights = {};   // of these; none: equal ones

  bool listed() const { return !values.empty(); }
  // With places evenly in [0, 1], values have the key's distribution.
  KeyValue ValueAt(double place) const;
  // The density of the value of ValueAt as a share of the largest that there is, in (0, 1].
  double DensityAt(double place) const;
  // The value of ValueAt as a place again: that of its grid, or of its entry in the list.
  double PlaceOf(const KeyValue& value) const;
  // ValueAt, numbers with two digits that count. Still in the range.
  KeyValue RoundedAt(double place) const;
  // "controller_parameters.turn_rate=0.5..2:log", "physics=impulse|box2d".
  std::string ToText() const;
};

// Why runs of one campaign cannot have different values of the key, behind its name: "gives every run its
// seed". Nothing: they can.
std::optional<std::string> WhyItCannotVary(const Key& key);

// Whether values are to be tried, or drawn, so that they need more than a range.
enum class Varied { kTried, kDrawn };

// Each text is KEY=LOW..HIGH, the same with ":log" behind it, or KEY=A|B|C; of what is drawn also
// KEY=LOW..HIGH:normal and KEY=A:3|B:1 with weights. `keys`: of the experiment, those
// of its scenario and controller among them. Numbers may begin with their point (".1"). Error: not of this
// form; no such key, or one that stands twice; a key that says how is searched or what is kept, a seed, a
// text; a value or an end of a range that the key does not take; LOW not below HIGH; a logarithm of what is
// not above 0; weights below 0, or that sum to nothing. It begins with "--vary TEXT: "; of what is drawn
// with nothing, since it stands in files too.
Result<std::vector<VariedKey>> ParseVariedKeys(const std::vector<std::string>& texts,
                                               std::span<const Key> keys, const Experiment& experiment,
                                               Varied varied = Varied::kTried);

// The experiment with other values. It may break a rule between keys (CheckRules).
Experiment WithValues(const Experiment& experiment, std::span<const VariedKey> varied,
                      std::span<const KeyValue> values);

}  // namespace gauntlet
