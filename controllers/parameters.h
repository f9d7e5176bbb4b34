// A behaviour's parameters: one row says everything about one of them, and which member of the settings takes
// its value.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/check.h"
#include "sim/robot/foot_bot.h"
#include "sim/run_spec.h"

namespace gauntlet::controllers {

// A row as programs that list and check parameters see it.
struct ParameterInfo {
  std::string name;
  std::string unit;  // "m", "m/s", "s", "rad", "" for counts, "bool" for 0/1
  double default_value = 0.0;
  double min = 0.0;
  double max = 0.0;
  bool integer = false;
  std::string description;  // one line, with the source of the default
  // Than stored campaigns: left out of specs and identities where it has its default. Not told as JSON, since
  // a plug-in, whose rows come so, is another one when it gains a parameter.
  bool came_later = false;

  bool operator==(const ParameterInfo&) const = default;
};

// Seconds as the nearest number of ticks.
inline sim::Tick ToTicks(double seconds) {
  return static_cast<sim::Tick>(std::floor(seconds * sim::kTicksPerSecond + 0.5));
}

// How a value enters the settings. A lambda serves where Into and IntoTicks do not.
template <typename Settings>
struct Fill {
  void (*set)(Settings& settings, double value) = nullptr;
  bool integer = false;  // only whole numbers make sense
};

namespace internal {

template <typename T>
T& ValueOf(T& object) {
  return object;
}
template <typename T>
T& ValueOf(std::optional<T>& object) {
  return object ? *object : object.emplace();
}

template <typename Object, typename First, typename... Rest>
auto& MemberOf(Object& object, First first, Rest... rest) {
  if constexpr (sizeof...(Rest) == 0) {
    return ValueOf(object.*first);
  } else {
    return MemberOf(ValueOf(object.*first), rest...);
  }
}

}  // namespace internal

// Into the member at the end of a path of pointers to members, converted to its type: a number, a count, a
// flag or an enumeration. An optional on the path comes to hold a value.
template <auto... kPath>
struct Into {
  template <typename Settings>
  constexpr operator Fill<Settings>() const {
    using Member = std::remove_reference_t<decltype(internal::MemberOf(std::declval<Settings&>(), kPath...))>;
    return {[](Settings& settings, double value) {
              internal::MemberOf(settings, kPath...) = static_cast<Member>(value);
            },
            !std::is_floating_point_v<Member>};
  }
};

// The same for a time: the parameter is in s, the member in ticks.
template <auto... kPath>
struct IntoTicks {
  template <typename Settings>
  constexpr operator Fill<Settings>() const {
    return {
        [](Settings& settings, double value) { internal::MemberOf(settings, kPath...) = ToTicks(value); }};
  }
};

// The last member of a row that came later than stored campaigns: its default is what was done before.
inline constexpr bool kCameLater = true;

template <typename Settings>
struct Parameter {
  std::string_view name;
  std::string_view unit;
  double default_value;
  double min;
  double max;
  Fill<Settings> fill;
  std::string_view description;
  bool came_later = false;
};

// The parameters of a scenario or a controller, which together give its settings.
template <typename Settings>
class ParameterTable {
 public:
  using Rows = std::vector<Parameter<Settings>>;

  explicit ParameterTable(const Rows& rows) { Append(rows); }
  // Another table's rows and some more.
  ParameterTable(const ParameterTable& first, const Rows& rows) : ParameterTable(first) { Append(rows); }

  // The same rows, which fill other settings.
  ParameterTable StartingFrom(const Settings& start) const {
    ParameterTable table = *this;
    table.start_ = start;
    return table;
  }

  const std::vector<ParameterInfo>& infos() const { return infos_; }

  // Rows fill the settings in their order. Aborts when `resolved` lacks one: the registry resolves.
  Settings Read(const sim::Parameters& resolved) const {
    Settings settings = start_;
    for (std::size_t i = 0; i < infos_.size(); ++i) {
      const auto found = resolved.find(infos_[i].name);
      GAUNTLET_CHECK(found != resolved.end(), "unresolved parameter " + infos_[i].name);
      set_[i](settings, found->second);
    }
    return settings;
  }

 private:
  void Append(const Rows& rows) {
    for (const Parameter<Settings>& row : rows) {
      infos_.push_back({std::string(row.name), std::string(row.unit), row.default_value, row.min, row.max,
                        row.fill.integer, std::string(row.description), row.came_later});
      set_.push_back(row.fill.set);
    }
  }

  Settings start_ = {};  // what the rows do not fill stays as it is here
  std::vector<ParameterInfo> infos_;
  std::vector<void (*)(Settings&, double)> set_;  // of the infos
};

}  // namespace gauntlet::controllers
