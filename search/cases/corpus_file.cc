#include "search/cases/corpus_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/system/atomic_file.h"
#include "proto/json_text.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostCorpusBytes = 16U << 20;
constexpr std::array<std::string_view, 7> kKeys = {"format", "name",       "expected", "found_in",
                                                   "found",  "experiment", "case"};

Error Wrong(const std::string& file, const std::string& what) {
  return InvalidInput(Printable(fmt::format("{}: {}", file, what)));
}

// Numbers stand as numbers, all else as text.
Json JsonOf(const std::string& value) {
  const Json number = Json::parse(value, nullptr, /*allow_exceptions=*/false);
  return number.is_number() ? number : Json(value);
}

// Error: another format, or a key that is missing or unknown.
Status CheckKeys(const nlohmann::json& json, const std::string& file) {
  if (!json.is_object() || !json.contains("format") || !json["format"].is_number_integer()) {
    return Wrong(file,
                 "no case of a corpus: it has no whole number \"format\". `gauntlet corpus add` makes one of "
                 "a case");
  }
  if (const auto format = json["format"].get<std::int64_t>(); format != kCorpusFormat) {
    return Wrong(file, fmt::format("format = {} is {}; this version reads format {}", format,
                                   format > kCorpusFormat ? "that of a newer version of gauntlet" : "none",
                                   kCorpusFormat));
  }
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(kKeys, key) != kKeys.end()) continue;
    const std::string near(NearestName(key, {kKeys.begin(), kKeys.end()}));
    return Wrong(file, fmt::format("unknown key '{}'{}", key,
                                   near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
  }
  for (const char* key : {"name", "expected", "experiment", "case"}) {
    if (!json.contains(key)) return Wrong(file, fmt::format("'{}' is missing", key));
  }
  return Ok{};
}

Status ReadSettings(const nlohmann::json& json, const std::string& file, CorpusCase& into) {
  if (!json.is_object()) return Wrong(file, "'experiment' is no object of keys and values");
  for (const auto& [key, value] : json.items()) {
    if (!value.is_string() && !value.is_number())
      return Wrong(file, fmt::format("experiment.{} is neither a number nor a text", key));
    if (value.is_string() && JsonOf(value.get<std::string>()).is_number()) {
      return Wrong(file, fmt::format("experiment.{} = \"{}\": a number stands without quotes", key,
                                     value.get<std::string>()));
    }
    into.settings.emplace_back(key, value.is_string() ? value.get<std::string>() : value.dump());
  }
  for (const char* key : {"scenario", "controller"}) {
    if (SettingOf(into, key).empty()) return Wrong(file, fmt::format("experiment.{} is missing", key));
  }
  return Ok{};
}

Status ReadFound(const nlohmann::json& json, const std::string& file, CorpusCase& into) {
  if (!json.contains("found")) return Ok{};
  const nlohmann::json& found = json["found"];
  const auto whole = [&](const char* key) {
    return found.is_object() && found.contains(key) && found[key].is_number_unsigned();
  };
  if (!whole("k") || !whole("n") || found["k"] > found["n"] || found["n"] > 1000000000)
    return Wrong(file, "'found' needs k failures of n runs, {\"k\": 5, \"n\": 5, ...}");
  into.found.failures = found["k"];
  into.found.runs = found["n"];
  if (!found.contains("interval")) return Ok{};
  const nlohmann::json& interval = found["interval"];
  if (!interval.is_array() || interval.size() != 2 || !interval[0].is_number() || !interval[1].is_number())
    return Wrong(file, "found.interval needs two numbers, from and to");
  into.found.interval = {interval[0].get<double>(), interval[1].get<double>()};
  const auto [from, to] = into.found.interval;
  const double share = static_cast<double>(into.found.failures) / std::max(into.found.runs, 1);
  if (!(0.0 <= from && from <= share && share <= to && to <= 1.0)) {
    return Wrong(file, fmt::format("found.interval = [{}, {}]: of a probability, with {} of {} within it, is "
                                   "needed",
                                   from, to, into.found.failures, into.found.runs));
  }
  return Ok{};
}

}  // namespace

std::string SettingOf(const CorpusCase& one, const std::string& key) {
  const auto setting = std::ranges::find(one.settings, key, &std::pair<std::string, std::string>::first);
  return setting == one.settings.end() ? "" : setting->second;
}

std::string WriteCorpusCase(const CorpusCase& one) {
  Json settings = Json::object();
  for (const auto& [key, value] : one.settings) settings[key] = JsonOf(value);
  return JsonText(
      {{"format", kCorpusFormat},
       {"name", one.name},
       {"expected", one.expected},
       {"found_in", one.found_in},
       {"found", {{"k", one.found.failures}, {"n", one.found.runs}, {"interval", one.found.interval}}},
       {"case", Json::parse(proto::WriteCaseDocument(one.document))},
       {"experiment", std::move(settings)}});
}

Result<CorpusCase> ParseCorpusCase(const std::string& text, const std::string& file_name) {
  TRY(const auto json, ParseJson(text, file_name));
  TRY(CheckKeys(json, file_name));
  CorpusCase one;
  one.name = TextAt(json, "name");
  const bool names_a_file =
      !one.name.empty() && one.name.front() != '.' &&
      std::ranges::none_of(one.name, [](unsigned char c) { return c == '/' || c < ' '; });
  if (!names_a_file) {
    return Wrong(file_name, fmt::format("name = '{}': a text that can name a file is needed", one.name));
  }
  one.expected = TextAt(json, "expected");
  if (std::ranges::find(kExpectations, one.expected) == std::end(kExpectations)) {
    return Wrong(file_name, fmt::format("expected = '{}': one of fail, flaky, pass is needed", one.expected));
  }
  if (json.contains("found_in") && !json["found_in"].is_string())
    return Wrong(file_name, "found_in is no text");
  one.found_in = TextAt(json, "found_in");
  TRY(ReadFound(json, file_name, one));
  TRY(ReadSettings(json["experiment"], file_name, one));
  TRY(one.document, proto::ParseCaseDocument(json["case"].dump(), file_name + ": case"));
  return one;
}

Result<std::vector<CorpusEntry>> ReadCorpus(const std::string& directory) {
  std::error_code error;
  if (fs::exists(directory + "/campaign.db", error)) {
    return InvalidInput(fmt::format(
        "{} is a campaign, no corpus: `gauntlet corpus add {} RUN_ID --to CORPUS` keeps cases of it",
        directory, directory));
  }
  if (fs::exists(directory, error) && !fs::is_directory(directory, error))
    return InvalidInput(fmt::format("{} is a file: a corpus is a folder of cases", directory));
  if (!fs::is_directory(directory, error)) {
    return Error{ErrorKind::kNotFound,
                 fmt::format("{}: no such folder; `gauntlet corpus add DIR RUN_ID --to {}` makes it",
                             directory, directory)};
  }
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, error)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  }
  if (files.empty()) {
    return InvalidInput(fmt::format("{} holds no case: `gauntlet corpus add DIR RUN_ID --to {}` adds one",
                                    directory, directory));
  }
  std::ranges::sort(files);
  std::vector<CorpusEntry> corpus;
  std::map<std::string, std::string> file_of;
  for (const std::string& file : files) {
    TRY(const auto text, ReadSmallFile(file, kMostCorpusBytes));
    TRY(auto one, ParseCorpusCase(text, file));
    const auto [other, is_new] = file_of.try_emplace(one.name, file);
    if (!is_new) {
      return InvalidInput(Printable(fmt::format(
          "{} and {} are both called '{}': give one of them another name", other->second, file, one.name)));
    }
    if (!corpus.empty() && SettingOf(corpus.front().content, "scenario") != SettingOf(one, "scenario")) {
      return InvalidInput(Printable(fmt::format(
          "{} is of the scenario '{}', {} of '{}': a corpus holds cases of one scenario", corpus.front().file,
          SettingOf(corpus.front().content, "scenario"), file, SettingOf(one, "scenario"))));
    }
    corpus.push_back({file, std::move(one)});
  }
  return corpus;
}

}  // namespace gauntlet
