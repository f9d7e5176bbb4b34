#include "study/fits/target_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/sample.h"
#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/split.h"
#include "base/system/atomic_file.h"
#include "controllers/registry.h"
#include "search/cases/case_file.h"
#include "search/experiment/toml_text.h"
#include "search/fit/fit_targets.h"
#include "study/questions/questioned_cases.h"
#include "study/sets/case_set.h"
#include "study/sets/csv_column.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 12> kTargetKeys = {"cases",    "metric", "formula", "statistic",
                                                          "quantile", "value",  "at_most", "n",
                                                          "at_least", "csv",    "column",  "runs"};

constexpr std::array<std::string_view, 6> kNumberKeys = {"quantile", "value",    "at_most",
                                                         "n",        "at_least", "runs"};

// A [[target]] or [[require]].
struct WrittenTarget {
  std::string kind;
  std::string where;
  std::vector<std::string> files;             // cases = ["FILE", ...]
  std::map<std::string, std::string> values;  // of the other keys

  std::string Take(const std::string& key) {
    auto node = values.extract(key);
    return node.empty() ? "" : std::move(node.mapped());
  }
};

class TargetFileReader {
 public:
  TargetFileReader(std::string path, const Experiment& experiment)
      : path_(std::move(path)), experiment_(experiment) {}

  Result<FitTargets> Read() {
    TRY(const std::string text, ReadSmallFile(path_));
    TRY(const auto assignments, ReadToml(text, path_));
    for (const Assignment& one : assignments) {
      TRY(Sort(one));
    }
    for (WrittenTarget& table : tables_) {
      TRY(Add(table));
    }
    if (std::ranges::count(tables_, "target", &WrittenTarget::kind) == 0)
      return InvalidInput(fmt::format("{}: there is no [[target]], so there is nothing to fit to", path_));
    return std::move(targets_);
  }

 private:
  // "target.1" begins a table, "target.1.metric" is of the last one.
  Status Sort(const Assignment& one) {
    const auto* other = std::get_if<OtherToml>(&one.value);
    const std::string kind = one.path.substr(0, one.path.find('.'));
    if (kind != "target" && kind != "require") {
      constexpr std::array<std::string_view, 2> kTableNames = {"target", "require"};
      return InvalidInput(fmt::format("{}: {}", one.where, UnknownName("table", kind, kTableNames)));
    }
    if (other != nullptr && other->kind == kListOfTables) {
      tables_.push_back({kind, one.where, {}, {}});
      return Ok{};
    }
    const std::string key = one.path.substr(one.path.rfind('.') + 1);
    if (tables_.empty() || std::ranges::count(one.path, '.') != 2)
      return InvalidInput(fmt::format("{}: targets are written as [[{}]]", one.where, kind));
    if (std::ranges::find(kTargetKeys, key) == kTargetKeys.end())
      return InvalidInput(fmt::format("{}: {}", one.where, UnknownName("key", key, kTargetKeys)));
    if (key == "cases" && other != nullptr && other->texts && !other->texts->empty()) {
      tables_.back().files = *other->texts;
      return Ok{};
    }
    if (other != nullptr || std::holds_alternative<bool>(one.value))
      return InvalidInput(
          fmt::format("{}: {} is {}, expected a number or text", one.where, key, KindOf(one.value)));
    const bool is_text = std::holds_alternative<std::string>(one.value);
    if (is_text && std::ranges::find(kNumberKeys, key) != kNumberKeys.end())
      return InvalidInput(fmt::format("{}: {} is text, expected a number", one.where, key));
    tables_.back().values[key] = TextOf(one.value);
    return Ok{};
  }

  Status Add(WrittenTarget& table) {
    TRY(const std::string cases, CasesOf(table));
    std::string line = "cases=" + cases;
    if (table.values.contains("csv")) {
      TRY(AddMeasured(table));
    }
    if (table.kind == "require" && !table.values.emplace("statistic", "every").second)
      return InvalidInput(fmt::format("{}: statistic has no place in [[require]]", table.where));
    if (table.values.contains("formula") && table.kind == "target")
      table.values.emplace("statistic", "share");
    TRY(SplitStatistic(table));
    const std::string formula = table.Take("formula");
    for (const auto& [key, value] : table.values) line += fmt::format(" {}={}", key, value);
    if (!formula.empty()) line += " formula=" + formula;
    const Result<std::vector<FitTarget>> parsed =
        ParseFitTargets(line, *controllers::FindScenario(experiment_));
    if (!parsed) return InvalidInput(fmt::format("{}: {}", table.where, parsed.error().message));
    for (const FitTarget& one : *parsed) targets_.text += (targets_.text.empty() ? "" : "; ") + one.ToText();
    return Ok{};
  }

  // statistic = "quantile:Q" and "share:FORMULA" are quantile = Q and formula = "FORMULA" in one.
  static Status SplitStatistic(WrittenTarget& table) {
    const auto statistic = table.values.find("statistic");
    if (statistic == table.values.end()) return Ok{};
    const std::string written = statistic->second;
    const std::string name = written.substr(0, written.find(':'));
    if (name == written || (name != "quantile" && name != "share")) return Ok{};
    const char* key = name == "share" ? "formula" : "quantile";
    const std::string_view rest = Trimmed(std::string_view(written).substr(name.size() + 1));
    if (const auto [other, is_new] = table.values.emplace(key, rest); !is_new)
      return InvalidInput(fmt::format("{}: statistic = {} and {} = {}: one of them says it", table.where,
                                      written, key, other->second));
    statistic->second = name;
    return Ok{};
  }

  // Values of a column, as a distribution.
  Status AddMeasured(WrittenTarget& table) {
    const std::string name = table.Take("csv");
    const fs::path file = fs::path(path_).parent_path() / name;
    std::string column = table.Take("column");
    if (column.empty()) column = table.values.contains("metric") ? table.values["metric"] : "";
    if (column.empty())
      return InvalidInput(
          fmt::format("{}: which column of {}? column = \"...\" is needed", table.where, name));
    table.values.emplace("metric", column);
    TRY(const CsvColumn measured, ReadCsvColumn(file, column));
    if (measured.values.size() < 2)
      return InvalidInput(fmt::format("{}: {} has {} in column {}; at least two are needed", table.where,
                                      file.string(), Counted(measured.values.size(), "value"), column));
    for (const char* key : {"statistic", "value", "at_most", "at_least", "n"}) {
      if (table.values.contains(key))
        return InvalidInput(
            fmt::format("{}: {} has no place beside csv, which has all values", table.where, key));
    }
    std::vector<std::string> blocks;
    for (const double block : BlockMeans(measured.values)) blocks.push_back(NumberText(block));
    table.values["statistic"] = "distribution";
    table.values["blocks"] = fmt::format("{}", fmt::join(blocks, ","));
    table.values["n"] = fmt::format("{}", measured.values.size());
    table.values["spread"] = NumberText(analysis::Describe(measured.values).sd.value());
    return Ok{};
  }

  // fit.targets' word for the cases of a table.
  Result<std::string> CasesOf(WrittenTarget& table) {
    const std::string named = table.Take("cases");
    if (table.files.empty()) {
      if (named.empty()) return std::string(table.kind == "require" ? "empty" : "random");
      if (ParseFitCases(named).ok() && !named.starts_with("given")) return named;
      table.files = {named};
    }
    const std::string list = fmt::format("{}", fmt::join(table.files, "\n"));
    if (const auto known = given_.find(list); known != given_.end()) return known->second;
    const std::size_t first = targets_.cases.size() + 1;
    for (const std::string& one : table.files) {
      const Status added = AddCases(one);
      if (!added) return Error{added.error().kind, fmt::format("{}: {}", table.where, added.error().message)};
    }
    if (targets_.cases.size() < first)
      return InvalidInput(fmt::format("{}: {} holds no case", table.where, table.files.front()));
    return given_[list] = fmt::format("given:{}-{}", first, targets_.cases.size());
  }

  Status AddCases(const std::string& name) {
    const std::string beside = (fs::path(path_).parent_path() / name).string();
    if (name.ends_with(".json") || name.ends_with(".argos")) {
      TRY(LoadedCase loaded, LoadCase(beside));
      if (!loaded.notice.empty()) targets_.notices.push_back(fmt::format("{}: {}", name, loaded.notice));
      return AddCase(std::move(loaded.test_case), name);
    }
    const Result<std::vector<CaseSet>> sets = ReadCaseSets(beside);
    if (!sets && sets.error().kind == ErrorKind::kNotFound)
      return InvalidInput(fmt::format(
          "cases = {}: neither random, random:N, empty, a case file nor a campaign's subset", name));
    if (!sets) return sets.error();
    for (const CaseSet& set : *sets) {
      for (const Individual& member : set.members) {
        TRY(AddCase(member.test_case, fmt::format("individual {} of {}", member.id, set.place)));
      }
    }
    return Ok{};
  }

  Status AddCase(sim::TestCase test_case, const std::string& name) {
    if (const auto refusal = RefusalOf(experiment_, test_case))
      return InvalidInput(fmt::format("{}: {}", name, refusal->message));
    targets_.cases.push_back(std::move(test_case));
    return Ok{};
  }

  std::string path_;
  const Experiment& experiment_;
  std::vector<WrittenTarget> tables_;
  std::map<std::string, std::string> given_;  // words for lists of cases
  FitTargets targets_;
};

}  // namespace

Result<FitTargets> ReadTargetFile(const std::string& path, const Experiment& experiment) {
  return TargetFileReader(path, experiment).Read();
}

}  // namespace gauntlet
