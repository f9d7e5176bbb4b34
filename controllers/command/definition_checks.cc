#include "controllers/command/definition_checks.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "controllers/command/metric_source.h"
#include "controllers/command/placeholders.h"
#include "controllers/command/trajectory_measures.h"
#include "controllers/generic/formula.h"

namespace gauntlet::controllers::command {
namespace {

using generic::Formula;

class Checks {
 public:
  Checks(const Definition& definition, std::size_t named) : definition_(definition), named_(named) {}

  std::optional<Complaint> Find() {
    for (const auto check : {&Checks::Run, &Checks::Files, &Checks::Metrics, &Checks::Judgement,
                             &Checks::Parameters, &Checks::Patterns, &Checks::Failures, &Checks::Arena}) {
      if (auto complaint = (this->*check)()) return complaint;
    }
    return std::nullopt;
  }

 private:
  using Found = std::optional<Complaint>;

  static std::string Numbered(const std::string& list, std::size_t index, const std::string& key) {
    return list + "." + std::to_string(index + 1) + "." + key;
  }

  Found Run() {
    if (definition_.run.empty() || definition_.run[0].empty())
      return Complaint{"run",
                       "run is missing: a program and its arguments, such as "
                       "[\"python3\", \"sim.py\", \"{case}\", \"{out}\", \"{seed}\"]"};
    for (const std::string& argument : definition_.run) {
      if (const Status right = CheckArgument(definition_, argument); !right)
        return Complaint{"run", "run: " + right.error().message};
    }
    return std::nullopt;
  }

  static bool IsPlainPath(const std::string& name) {
    if (name.empty() || name.size() > 255 || name.front() == '/' || name.find('\0') != std::string::npos)
      return false;
    std::size_t begin = 0;
    while (begin <= name.size()) {
      const std::size_t end = std::min(name.find('/', begin), name.size());
      const std::string_view part = std::string_view(name).substr(begin, end - begin);
      if (part == ".." || (part.empty() && end != name.size()) || part.starts_with(".gauntlet-"))
        return false;
      begin = end + 1;
    }
    return true;
  }

  Found Files() {
    const auto wrong = [](const std::string& key, const std::string& name) {
      return Complaint{key, key + ": '" + name +
                                "' is no path below a folder: names joined by '/', without '..' and not "
                                "beginning with '/' or .gauntlet-"};
    };
    for (const std::string& name : definition_.names) {
      if (!IsPlainPath(name)) return wrong("files", name);
    }
    for (const File& file : definition_.files) {
      if (!IsPlainPath(file.name)) return wrong("file", file.name);
    }
    if (!definition_.trajectory.empty() && !IsPlainPath(definition_.trajectory))
      return wrong("trajectory", definition_.trajectory);
    return std::nullopt;
  }

  Found Metrics() {
    for (std::size_t i = 0; i < definition_.metrics.size(); ++i) {
      const Metric& metric = definition_.metrics[i];
      const auto path_of = [&](const char* key) {
        return i < named_ ? std::string("metrics") : Numbered("metric", i - named_, key);
      };
      const std::string path = path_of("name");
      if (!IsVariable(metric.name))
        return Complaint{path, "the metric '" + metric.name +
                                   "': a name has letters, digits and _, begins with a letter, and is no "
                                   "function of formulas"};
      if (std::ranges::count(names_, metric.name) > 0)
        return Complaint{path, "the metric '" + metric.name + "' is given twice"};
      if (!metric.from.empty() && !metric.formula.empty())
        return Complaint{path,
                         "the metric '" + metric.name + "' has both `from` and `formula`: one is possible"};
      if (metric.from.starts_with(kTrajectorySource)) {
        if (auto complaint = MeasureComplaint(path_of("from"), metric.from)) return complaint;
      } else if (!metric.from.empty()) {
        if (const Status right = CheckSource(metric.from); !right)
          return Complaint{path_of("from"), "the metric '" + metric.name + "': " + right.error().message};
      }
      if (!metric.formula.empty()) {
        if (auto complaint = FormulaComplaint(path_of("formula"), metric.formula)) return complaint;
      }
      names_.push_back(metric.name);
    }
    if (names_.empty())
      return Complaint{"metrics",
                       "metrics is missing: names of the numbers that the program reports, such as "
                       "[\"items\"]"};
    return std::nullopt;
  }

  Found MeasureComplaint(const std::string& path, const std::string& from) const {
    const std::string name = from.substr(kTrajectorySource.size());
    if (definition_.trajectory.empty())
      return Complaint{path, path + " = " + from + " needs the key trajectory"};
    if (FindByName(TrajectoryMeasureNames(), name) != nullptr) return std::nullopt;
    return Complaint{path, path + ": " + UnknownName("measure", name, TrajectoryMeasureNames())};
  }

  static bool IsVariable(const std::string& name) {
    constexpr std::string_view kFunctions[] = {"min", "max", "abs", "sqrt"};
    return IsName(name) && name.find_first_of(".-") == std::string::npos &&
           !(name.front() >= '0' && name.front() <= '9') && std::ranges::count(kFunctions, name) == 0;
  }

  Found FormulaComplaint(const std::string& path, const std::string& formula) const {
    const Result<Formula> compiled = Formula::Compile(formula, names_);
    if (compiled) return std::nullopt;
    return Complaint{path, path + " = " + QuoteToml(formula) + ": " + compiled.error().message};
  }

  Found Judgement() {
    for (const auto& [name, formula] :
         {std::pair("fitness", &definition_.fitness), std::pair("failure", &definition_.failure)}) {
      if (formula->empty())
        return Complaint{name, std::string(name) + " is missing: a formula of metrics, such as \"" +
                                   names_.front() + (name[1] == 'i' ? "\"" : " < 5\"")};
      if (auto complaint = FormulaComplaint(name, *formula)) return complaint;
    }
    return std::nullopt;
  }

  Found Parameters() {
    std::set<std::string> names;
    for (std::size_t i = 0; i < definition_.parameters.size(); ++i) {
      const ParameterInfo& one = definition_.parameters[i];
      if (!IsName(one.name))
        return Complaint{Numbered("parameter", i, "name"), "'" + one.name + "' is no name"};
      if (!names.insert(one.name).second)
        return Complaint{Numbered("parameter", i, "name"), "the parameter '" + one.name + "' is given twice"};
      const auto whole = [](double value) { return value == std::floor(value); };
      if (one.integer && !(whole(one.default_value) && whole(one.min) && whole(one.max)))
        return Complaint{
            Numbered("parameter", i, "default"),
            "the parameter '" + one.name + "' is an integer: default = " + NumberText(one.default_value) +
                ", low = " + NumberText(one.min) + " and high = " + NumberText(one.max) + " must be whole"};
      if (one.min > one.default_value || one.default_value > one.max)
        return Complaint{Numbered("parameter", i, "default"),
                         "the parameter '" + one.name + "': its default " + NumberText(one.default_value) +
                             " is not within low = " + NumberText(one.min) +
                             " and high = " + NumberText(one.max)};
    }
    return std::nullopt;
  }

  Found Patterns() {
    for (std::size_t i = 0; i < definition_.refused.size(); ++i) {
      if (const Status right = CheckPattern(definition_.refused[i]); !right)
        return Complaint{Numbered("refused", i, "pattern"), right.error().message};
    }
    return std::nullopt;
  }

  Found Unknown(const std::string& path, const std::string& metric) const {
    if (std::ranges::count(names_, metric) > 0) return std::nullopt;
    return Complaint{path, path + ": " + UnknownName("metric", metric, names_)};
  }

  Found Failures() {
    for (std::size_t i = 0; i < definition_.axes.size(); ++i) {
      const DescriptorAxis& axis = definition_.axes[i];
      if (auto complaint = Unknown(Numbered("axis", i, "metric"), axis.metric)) return complaint;
      if (!(axis.min < axis.max))
        return Complaint{Numbered("axis", i, "min"), "the axis of '" + axis.metric + "' goes from " +
                                                         NumberText(axis.min) + " to " +
                                                         NumberText(axis.max)};
    }
    if (!definition_.place) return std::nullopt;
    if (auto complaint = Unknown("place.x", definition_.place->x)) return complaint;
    if (auto complaint = Unknown("place.y", definition_.place->y)) return complaint;
    if (definition_.place->same_within > 0.0) return std::nullopt;
    return Complaint{"place.same_within",
                     "place.same_within is missing: m, so far apart failures are the same"};
  }

  Found Arena() {
    std::set<std::string> names;
    for (std::size_t i = 0; i < definition_.points.size(); ++i) {
      const Point& point = definition_.points[i];
      if (point.name.empty() || !names.insert(point.name).second)
        return Complaint{Numbered("point", i, "name"),
                         "points have names that differ, such as \"start\", \"goal\""};
    }
    for (const auto& [list, shapes] :
         {std::pair("keep_out", &definition_.keep_outs), std::pair("standing", &definition_.standing)}) {
      for (std::size_t i = 0; i < shapes->size(); ++i) {
        const Shape& shape = (*shapes)[i];
        const bool disc = shape.radius > 0.0 && shape.length == 0.0 && shape.width == 0.0;
        if (disc || (shape.radius == 0.0 && shape.length > 0.0 && shape.width > 0.0)) continue;
        return Complaint{Numbered(list, i, "radius"),
                         std::string(list) + ": a disc has a radius, a rectangle a length and a width, in m"};
      }
    }
    return std::nullopt;
  }

  const Definition& definition_;
  std::size_t named_;
  std::vector<std::string> names_;  // of metrics
};

}  // namespace

std::optional<Complaint> FindContradiction(const Definition& definition, std::size_t named) {
  return Checks(definition, named).Find();
}

}  // namespace gauntlet::controllers::command
