// A line by which a program asks for an evaluation, and the answer to it: JSON objects,
// docs/evaluate-stdin.md.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "base/result.h"
#include "master/store/result_store.h"
#include "search/experiment/experiment.h"
#include "search/experiment/schema.h"
#include "search/given/case_stream.h"

namespace gauntlet {

struct EvaluationLine {
  std::string id;  // "" = none was given
  StreamedCase asked;
  // JSON of all that it asks for, the case by its hash: lines that ask for the same have the same.
  std::string content;
};

// What is wrong with a line.
struct LineError {
  std::string id;    // as far as it could be read
  std::string rule;  // that the case breaks, "no-path"; "" = none that has a name
  std::string message;
};

// Reads lines of one experiment. Not thread-safe.
class EvaluationLineReader {
 public:
  static constexpr std::size_t kLongestId = 200;  // bytes

  explicit EvaluationLineReader(const Experiment& experiment);

  // The line, or in `wrong` why it is none. Files are looked for where the process stands.
  std::optional<EvaluationLine> Read(std::string_view text, LineError& wrong);
  // What a stored line asks for, of a case that is stored apart.
  Result<StreamedCase> Restore(const StoredLine& line, sim::TestCase test_case);

 private:
  // All of it but id and case, into `asked`; in `content` as it is written.
  Status ReadSettings(const nlohmann::json& json, StreamedCase& asked, nlohmann::ordered_json& content);
  Result<std::shared_ptr<const Experiment>> SettingsOf(const nlohmann::json& set);

  const Experiment experiment_;
  const std::vector<Key> keys_;
  const std::string text_;  // the experiment as TOML
  // By the JSON of the set; few at a time, since a search seldom comes back to one.
  std::map<std::string, std::shared_ptr<const Experiment>> settings_;
};

// The answer to the `number`th line: its fitness, mean of the completed runs, how many runs failed, and what
// became of each. The runs have their metrics.
nlohmann::ordered_json AnswerOf(const Experiment& experiment, std::string_view id, std::uint64_t number,
                                IndividualId individual, std::span<const StoredRun* const> runs);
nlohmann::ordered_json AnswerOf(const LineError& wrong, std::uint64_t number);

}  // namespace gauntlet
