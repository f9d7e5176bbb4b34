#include "controllers/command/placeholders.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <optional>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::command {
namespace {

constexpr std::string_view kParameters = "parameters.";

// What a name stands for; nothing when it stands for nothing.
using Values = std::function<std::optional<std::string>(std::string_view name)>;

std::string ParameterText(double value) {
  return NumberText(value == 0.0 ? 0.0 : value);  // without the sign of zero
}

std::optional<std::string> RunValue(const sim::RunSpec& spec, std::string_view name) {
  if (name == "seed") return std::to_string(SeedOf(spec.seed));
  if (name == "seed64") return std::to_string(spec.seed);
  if (!name.starts_with(kParameters)) return std::nullopt;
  const auto found = spec.controller_parameters.find(std::string(name.substr(kParameters.size())));
  if (found == spec.controller_parameters.end()) return std::nullopt;
  return ParameterText(found->second);
}

std::optional<std::string> ObstacleValue(const sim::ObstacleGene& gene, std::size_t index,
                                         std::string_view name) {
  if (name == "number") return std::to_string(index + 1);
  if (name == "x") return NumberText(gene.x);
  if (name == "y") return NumberText(gene.y);
  if (name == "length") return NumberText(gene.length);
  if (name == "width") return NumberText(gene.width);
  if (name == "half_length") return NumberText(gene.length / 2.0);
  if (name == "half_width") return NumberText(gene.width / 2.0);
  if (name == "degrees") return NumberText(gene.orientation_deg);
  if (name == "radians") return NumberText(gene.orientation_deg * sim::kPi / 180.0);
  return std::nullopt;
}

// Every name that is there, for messages.
std::vector<std::string> Known(const Definition& definition, std::initializer_list<std::string_view> more) {
  std::vector<std::string> names(more.begin(), more.end());
  names.insert(names.end(), {"seed", "seed64"});
  for (const ParameterInfo& parameter : definition.parameters)
    names.push_back(std::string(kParameters) + parameter.name);
  return names;
}

// The text with each {NAME} replaced; "{{" is a brace. Error: which name is unknown.
Result<std::string> Replaced(std::string_view text, const Values& values,
                             const std::vector<std::string>& known) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool doubled = i + 1 < text.size() && text[i + 1] == text[i];
    if ((text[i] == '{' || text[i] == '}') && doubled) {
      result += text[i++];
      continue;
    }
    if (text[i] != '{') {
      result += text[i];
      continue;
    }
    const std::size_t end = text.find('}', i);
    if (end == std::string_view::npos)
      return InvalidInput("'" + std::string(text) + "': a '{' without '}'; write {{ for a brace");
    const std::string_view name = text.substr(i + 1, end - i - 1);
    const std::optional<std::string> value = values(name);
    if (!value)
      return InvalidInput("'" + std::string(text) + "': " + UnknownName("placeholder", name, known) +
                          "; write {{ for a brace");
    result += *value;
    i = end;
  }
  return result;
}

// The line with each @NAME@ replaced; "@@" is one. What stands between two of them and is no name stays.
Result<std::string> FilledLine(std::string_view line, const Values& values,
                               const std::vector<std::string>& known) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  std::string result;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] != '@') {
      result += line[i];
      continue;
    }
    const std::size_t end = line.find('@', i + 1);
    if (end == i + 1) {
      result += line[i++];
      continue;
    }
    const std::string_view name = end == std::string_view::npos ? "" : line.substr(i + 1, end - i - 1);
    if (name.empty() || name.find_first_not_of(kLetters) != std::string_view::npos) {
      result += line[i];
      continue;
    }
    const std::optional<std::string> value = values(name);
    if (!value) return InvalidInput(UnknownName("mark", name, known) + "; write @@ for one @");
    result += *value;
    i = end;
  }
  return result;
}

struct TemplateParts {
  std::vector<std::string_view> before;
  std::vector<std::string_view> obstacle;
  std::vector<std::string_view> behind;
};

Result<TemplateParts> SplitTemplate(std::string_view text) {
  TemplateParts parts;
  std::vector<std::string_view>* into = &parts.before;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    ++number;
    const bool begins = line.find("@obstacles@") != std::string_view::npos;
    const bool ends = line.find("@end@") != std::string_view::npos;
    if (begins != ends && into == (begins ? &parts.before : &parts.obstacle)) {
      into = begins ? &parts.obstacle : &parts.behind;
      continue;
    }
    if (begins || ends)
      return InvalidInput("line " + std::to_string(number) +
                          ": one line with @obstacles@, and behind it one with @end@, are possible");
    into->push_back(line);
  }
  if (into == &parts.behind) return parts;
  return InvalidInput(std::string("there is no line with ") +
                      (into == &parts.before ? "@obstacles@" : "@end@") +
                      "; what stands between the two is repeated for each obstacle");
}

const std::array<std::string_view, 9> kOfObstacles = {
    "number", "x", "y", "length", "width", "half_length", "half_width", "degrees", "radians"};

Result<std::string> Filled(const Definition& definition, std::string_view text, const sim::RunSpec& spec,
                           const sim::Genome& obstacles) {
  TRY(const TemplateParts parts, SplitTemplate(text));
  std::string filled;
  const auto add = [&](const std::vector<std::string_view>& lines, const Values& values,
                       const std::vector<std::string>& known) -> Status {
    for (const std::string_view line : lines) {
      Result<std::string> one = FilledLine(line, values, known);
      const auto number = 1 + std::count(text.data(), line.data(), '\n');
      if (!one) return InvalidInput("line " + std::to_string(number) + ": " + one.error().message);
      filled += *one;
    }
    return Ok{};
  };
  const Values of_run = [&](std::string_view name) { return RunValue(spec, name); };
  TRY(add(parts.before, of_run, Known(definition, {})));
  std::vector<std::string> known = Known(definition, {});
  known.insert(known.begin(), kOfObstacles.begin(), kOfObstacles.end());
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Values of_obstacle = [&](std::string_view name) {
      const auto own = ObstacleValue(obstacles[i], i, name);
      return own ? own : RunValue(spec, name);
    };
    TRY(add(parts.obstacle, of_obstacle, known));
  }
  TRY(add(parts.behind, of_run, Known(definition, {})));
  return filled;
}

// A run with a value for each parameter.
sim::RunSpec AnyRun(const Definition& definition) {
  sim::RunSpec spec;
  for (const ParameterInfo& parameter : definition.parameters)
    spec.controller_parameters[parameter.name] = parameter.default_value;
  return spec;
}

Values ArgumentValues(const Definition& definition, const sim::RunSpec& spec) {
  return [&](std::string_view name) -> std::optional<std::string> {
    if (name == "case") return CaseFileOf(definition);
    if (name == "out") return kOutFile;
    return RunValue(spec, name);
  };
}

}  // namespace

std::string CaseFileOf(const Definition& definition) {
  if (definition.case_template.empty()) return "case.json";
  return "case" + std::filesystem::path(definition.case_template).extension().string();
}

std::uint32_t SeedOf(std::uint64_t seed) {
  constexpr std::uint64_t kLargest = (std::uint64_t{1} << 31) - 1;
  return static_cast<std::uint32_t>(1 + seed % kLargest);
}

Status CheckArgument(const Definition& definition, const std::string& argument) {
  if (argument.find('\0') != std::string::npos) return InvalidInput("an argument holds a zero byte");
  const sim::RunSpec spec = AnyRun(definition);
  TRY(Replaced(argument, ArgumentValues(definition, spec), Known(definition, {"case", "out"})));
  return Ok{};
}

std::vector<std::string> ArgumentsOf(const Definition& definition, const sim::RunSpec& spec) {
  std::vector<std::string> arguments;
  for (const std::string& argument : definition.run)
    arguments.push_back(*Replaced(argument, ArgumentValues(definition, spec), {}));
  return arguments;
}

Status CheckTemplate(const Definition& definition, std::string_view text) {
  TRY(Filled(definition, text, AnyRun(definition), {sim::ObstacleGene{}}));
  return Ok{};
}

std::string FillTemplate(const Definition& definition, std::string_view text, const sim::RunSpec& spec) {
  return *Filled(definition, text, spec, spec.test_case.obstacles);
}

}  // namespace gauntlet::controllers::command
