// The master's one place where protobuf meets plain structs.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::v1 {
class RunSpec;
}

namespace gauntlet::master {

std::string EncodeRunSpec(const sim::RunSpec& spec);
// EncodeRunSpec of specs that differ in their seed only: all else is translated once.
class SeededSpecs {
 public:
  explicit SeededSpecs(const sim::RunSpec& spec);
  SeededSpecs(const SeededSpecs&) = delete;
  SeededSpecs& operator=(const SeededSpecs&) = delete;
  ~SeededSpecs();
  std::string Encode(std::uint64_t seed);

 private:
  std::unique_ptr<v1::RunSpec> message_;
};
Result<sim::RunSpec> DecodeRunSpec(std::string_view bytes);
// Without trajectory and cost's influence on the hash; the hash is checked: Error(kCorrupt) when it does not
// match the content.
Result<sim::RunResult> DecodeRunResult(std::string_view bytes);
std::string EncodeRunResult(const sim::RunResult& result);

// User-facing case files: proto3 JSON. Errors name file, line and column.
Result<sim::TestCase> ParseCaseJson(const std::string& text, const std::string& file_name);
std::string WriteCaseJson(const sim::TestCase& test_case);

}  // namespace gauntlet::master
