#include "study/streams/evaluation_line.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "base/mean_and_range.h"
#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "base/utf8.h"
#include "controllers/registry.h"
#include "master/dispatch/leases/run_limits.h"
#include "proto/case_json.h"
#include "proto/json_text.h"
#include "search/cases/case_file.h"
#include "search/experiment/experiment_file.h"
#include "search/experiment/varied_keys.h"
#include "search/failure_tally.h"
#include "search/search_table.h"
#include "study/questions/case_answer.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr const char* kLine = "line";  // how errors call the text
constexpr std::size_t kMostSettings = 256;
const std::vector<std::string> kKeys = {"id", "case", "file", "set", "seed", "replicates"};

Error Wrong(const std::string& key, const nlohmann::json& value, const std::string& expected) {
  return InvalidInput(fmt::format(
      "{} is {}, expected {}", key,
      value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).substr(0, 80), expected));
}

Status CheckKeys(const nlohmann::json& json) {
  if (!json.is_object()) return Wrong("the line", json, "an object { ... }");
  for (const auto& [name, value] : json.items()) {
    if (std::ranges::count(kKeys, name) == 0) return InvalidInput(UnknownName("key", name, kKeys));
  }
  return Ok{};
}

Result<sim::TestCase> CaseOf(const nlohmann::json& json) {
  if (json.contains("case") == json.contains("file"))
    return InvalidInput("which case? Either \"case\": { ... } or \"file\": \"PATH\"");
  if (json.contains("case")) {
    TRY(proto::CaseDocument document, proto::ParseCaseDocument(json["case"].dump(), "case"));
    return std::move(document.test_case);
  }
  if (!json["file"].is_string()) return Wrong("file", json["file"], "the path of a case file");
  const std::string file = json["file"].get<std::string>();
  std::error_code error;  // a missing one is told by LoadCase
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    return InvalidInput(Printable(file) + " is no regular file, and a line can name nothing else");
  TRY(LoadedCase loaded, LoadCase(file));
  return std::move(loaded.test_case);
}

// Why lines cannot give the key another value.
std::optional<std::string> WhyNot(const Key& key) {
  if (key.path == "scenario" || key.path == "controller")
    return "is the same for all lines: begin another campaign for another " + key.path;
  for (const std::string_view of_case : {"genome.", "arena."}) {
    if (key.path.starts_with(of_case)) return "is said by the case";
  }
  return WhyItCannotVary(key);
}

// "KEY=VALUE", as --set takes it.
Result<std::string> SetOf(const std::string& path, const nlohmann::json& value, std::span<const Key> keys) {
  const auto key = std::ranges::find(keys, path, &Key::path);
  if (key == keys.end()) return InvalidInput("set: " + UnknownName("key", path, keys));
  if (const auto reason = WhyNot(*key)) return InvalidInput(fmt::format("set: {} {}", path, *reason));
  if (!value.is_primitive() || value.is_null()) return Wrong("set: " + path, value, ExpectationOf(*key));
  return fmt::format("{}={}", path, value.is_string() ? value.get<std::string>() : value.dump());
}

}  // namespace

EvaluationLineReader::EvaluationLineReader(const Experiment& experiment)
    : experiment_(experiment),
      keys_(AllKeysOf(experiment)),
      text_(WriteExperiment(experiment, {}, BuiltInCatalogue())) {}

Result<std::shared_ptr<const Experiment>> EvaluationLineReader::SettingsOf(const nlohmann::json& set) {
  const std::string name = set.dump();
  if (const auto known = settings_.find(name); known != settings_.end()) return known->second;
  std::vector<std::string> sets;
  for (const auto& [path, value] : set.items()) {
    TRY(std::string one, SetOf(path, value, keys_));
    sets.push_back(std::move(one));
  }
  Result<Experiment> changed = ParseExperiment(text_, kLine, sets, BuiltInCatalogue());
  if (!changed) {
    constexpr std::string_view kAsTyped = "--";
    std::string message = changed.error().message;
    if (message.starts_with(kAsTyped)) message.erase(0, kAsTyped.size());
    return InvalidInput(message);
  }
  const double most = CpuLimitSeconds(experiment_);
  if (CpuLimitSeconds(*changed) > most) {
    return InvalidInput(fmt::format(
        "set: runs would simulate for longer than the experiment's, whose runs are ended after {} s of "
        "CPU time: begin with the longest, by --set",
        most));
  }
  if (settings_.size() == kMostSettings) settings_.clear();
  return settings_[name] = std::make_shared<const Experiment>(*std::move(changed));
}

Status EvaluationLineReader::ReadSettings(const nlohmann::json& json, StreamedCase& asked,
                                          OrderedJson& content) {
  asked.replicates = static_cast<std::uint32_t>(experiment_.search.replicates);
  if (json.contains("set")) {
    const nlohmann::json& set = json["set"];
    if (!set.is_object()) return Wrong("set", set, "an object {\"KEY\": VALUE, ...}");
    if (!set.empty()) {
      TRY(asked.settings, SettingsOf(set));
      content["set"] = set;
    }
  }
  if (json.contains("seed")) {
    const nlohmann::json& seed = json["seed"];
    if (seed.is_number_unsigned()) asked.seed = seed.get<std::uint64_t>();
    if (seed.is_string()) asked.seed = ParseNumber<std::uint64_t>(seed.get<std::string>());
    if (!asked.seed) return Wrong("seed", seed, "a whole number, 0 to 2^64-1");
    content["seed"] = *asked.seed;
  }
  if (json.contains("replicates")) {
    const nlohmann::json& replicates = json["replicates"];
    const auto key = std::ranges::find(keys_, "search.replicates", &Key::path);
    if (!replicates.is_number_unsigned() || CheckValue(*key, replicates.get<std::int64_t>()))
      return Wrong("replicates", replicates, ExpectationOf(*key));
    asked.replicates = replicates.get<std::uint32_t>();
  }
  content["replicates"] = asked.replicates;
  return Ok{};
}

std::optional<EvaluationLine> EvaluationLineReader::Read(std::string_view text, LineError& wrong) {
  EvaluationLine line;
  const Status read = [&]() -> Status {
    TRY(const nlohmann::json json, ParseJson(text, kLine));
    if (json.is_object() && json.contains("id")) {
      const nlohmann::json& id = json["id"];
      if (!id.is_string() || id.get_ref<const std::string&>().empty() ||
          id.get_ref<const std::string&>().size() > kLongestId)
        return Wrong("id", id, fmt::format("a text of 1 to {} bytes", kLongestId));
      wrong.id = line.id = id.get<std::string>();
    }
    TRY(CheckKeys(json));
    TRY(line.asked.test_case, CaseOf(json));
    Fnv1a64 hash;
    hash.AddBytes(proto::WriteCaseJson(line.asked.test_case));
    OrderedJson content = {{"case", fmt::format("{:016x}", hash.value())}};
    TRY(ReadSettings(json, line.asked, content));
    line.content = content.dump();
    const Experiment& experiment =
        line.asked.settings ? static_cast<const Experiment&>(*line.asked.settings) : experiment_;
    const std::optional<CaseRefusal> refusal = RefusalOf(experiment, line.asked.test_case);
    if (!refusal) return Ok{};
    wrong.rule = refusal->rule;
    return InvalidInput(refusal->message);
  }();
  if (read) return line;
  wrong.message = read.error().message;
  return std::nullopt;
}

Result<StreamedCase> EvaluationLineReader::Restore(const StoredLine& line, sim::TestCase test_case) {
  StreamedCase asked{.test_case = std::move(test_case)};
  OrderedJson content;
  TRY(const nlohmann::json json,
      ParseJson(line.content, fmt::format("the line of individual {}", line.individual)));
  TRY(ReadSettings(json, asked, content));
  return asked;
}

OrderedJson AnswerOf(const Experiment& experiment, std::string_view id, std::uint64_t number,
                     IndividualId individual, std::span<const StoredRun* const> runs) {
  const controllers::FailureTypes& types = controllers::DeclaredScenario(experiment).failure_types;
  FailureTally tally;
  MeanAndRange fitness;
  std::vector<CaseRun> all;
  for (const StoredRun* run : runs) {
    CaseRun& one = all.emplace_back(CaseRun{.id = run->id, .seed = run->seed});
    one.result.verdict = run->verdict;
    one.result.fitness = run->fitness;
    one.result.metrics = run->metrics;
    one.result.hash = run->hash;
    one.result.message = run->message;
    one.result.failure.total = run->total_failure;
    one.result.failure.type = run->failure_type;
    if (const controllers::FailureType* type = types.Find(run->failure_type))
      one.result.failure.label = type->name;
    tally.Add(*run, FailingOf(experiment));
    if (run->completed()) fitness.Add(run->fitness);
  }
  return {{"id", id.empty() ? OrderedJson() : OrderedJson(id)},
          {"line", number},
          {"individual", individual},
          {"fitness", fitness.count() > 0 ? OrderedJson(fitness.mean()) : OrderedJson()},
          {"failures", tally.failures},
          {"runs", TableOf(all).ToJson()}};
}

OrderedJson AnswerOf(const LineError& wrong, std::uint64_t number) {
  OrderedJson answer = {{"id", wrong.id.empty() ? OrderedJson() : OrderedJson(wrong.id)},
                        {"line", number},
                        {"error", ToUtf8(wrong.message)}};
  if (!wrong.rule.empty()) answer["rule"] = wrong.rule;
  return answer;
}

}  // namespace gauntlet
