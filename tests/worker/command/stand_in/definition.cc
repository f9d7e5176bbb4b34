// Stands in for controllers/command while that is written: of each function as much as the tests of
// worker/command need. Goes with the folder.
#include "controllers/command/definition.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "controllers/command/outcome.h"
#include "controllers/command/placeholders.h"

namespace gauntlet::controllers::command {
namespace {

using nlohmann::json;

std::string Contents(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string Replaced(std::string text, const std::string& name, const std::string& value) {
  for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += value.size())
    text.replace(at, name.size(), value);
  return text;
}

}  // namespace

Result<Definition> Parse(std::string_view canonical) {
  const json table = json::parse(canonical, nullptr, false);
  if (!table.is_object()) return InvalidInput("it is no definition of a command");
  Definition definition;
  table.at("run").get_to(definition.run);
  table.at("probe").get_to(definition.probe);
  table.at("refused").get_to(definition.refused);
  for (const json& file : table.at("files"))
    definition.files.push_back({file.at("name"), file.at("hash"), file.at("executable")});
  for (const json& name : table.at("metrics")) definition.metrics.push_back({name, "", "", ""});
  table.at("case_template").get_to(definition.case_template);
  table.at("cpu_limit").get_to(definition.cpu_limit);
  table.at("wall_limit").get_to(definition.wall_limit);
  table.at("memory").get_to(definition.memory);
  table.at("disk").get_to(definition.disk);
  table.at("cores").get_to(definition.cores);
  table.at("setup").get_to(definition.setup);
  table.at("confine").get_to(definition.confine);
  return definition;
}

std::string CanonicalText(const Definition& definition) {
  json files = json::array();
  for (const File& file : definition.files)
    files.push_back({{"name", file.name}, {"hash", file.hash}, {"executable", file.executable}});
  json metrics = json::array();
  for (const Metric& metric : definition.metrics) metrics.push_back(metric.name);
  return json{{"run", definition.run},
              {"probe", definition.probe},
              {"refused", definition.refused},
              {"files", files},
              {"metrics", metrics},
              {"case_template", definition.case_template},
              {"cpu_limit", definition.cpu_limit},
              {"wall_limit", definition.wall_limit},
              {"memory", definition.memory},
              {"disk", definition.disk},
              {"cores", definition.cores},
              {"setup", definition.setup},
              {"confine", definition.confine}}
      .dump(1);
}

std::string CaseFileOf(const Definition& definition) {
  const std::size_t dot = definition.case_template.rfind('.');
  return definition.case_template.empty() ? "case.json" : "case" + definition.case_template.substr(dot);
}

std::vector<std::string> ArgumentsOf(const Definition& definition, const sim::RunSpec& spec) {
  std::vector<std::string> arguments;
  for (const std::string& argument : definition.run) {
    std::string text = Replaced(argument, "{case}", CaseFileOf(definition));
    text = Replaced(Replaced(text, "{out}", kOutFile), "{seed}", std::to_string(spec.seed));
    arguments.push_back(Replaced(Replaced(text, "{{", "{"), "}}", "}"));
  }
  return arguments;
}

std::string FillTemplate(const Definition&, std::string_view text, const sim::RunSpec& spec) {
  return Replaced(std::string(text), "@seed@", std::to_string(spec.seed));
}

std::optional<std::string> RefusedBy(const Definition& definition, const std::string& folder) {
  std::istringstream printed(Contents(folder + "/" + kStdoutFile) + Contents(folder + "/" + kStderrFile));
  for (std::string line; std::getline(printed, line);) {
    for (const std::string& pattern : definition.refused)
      if (line.find(pattern) != std::string::npos) return line;
  }
  return std::nullopt;
}

Result<sim::RunResult> OutcomeOf(const Definition& definition, const sim::RunSpec&,
                                 const std::string& folder) {
  const json object = json::parse(Contents(folder + "/" + kOutFile), nullptr, false);
  if (!object.is_object()) return InvalidInput("it has not written out.json");
  sim::RunResult result;
  for (const Metric& metric : definition.metrics)
    result.metrics.emplace_back(metric.name, object.at(metric.name));
  result.fitness = result.metrics.at(0).second;
  sim::SetHashes(result);
  return result;
}

}  // namespace gauntlet::controllers::command
