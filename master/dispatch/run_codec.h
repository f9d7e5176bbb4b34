// The master's one place where protobuf meets plain structs.
#pragma once

#include <string>
#include <string_view>

#include "sim/base/result.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::master {

std::string EncodeRunSpec(const sim::RunSpec& spec);
Result<sim::RunSpec> DecodeRunSpec(std::string_view bytes);
// Without trajectory and cost's influence on the hash; the hash is checked: Error(kCorrupt) when it does not
// match the content.
Result<sim::RunResult> DecodeRunResult(std::string_view bytes);
std::string EncodeRunResult(const sim::RunResult& result);

// User-facing case files: proto3 JSON. Errors name file, line and column.
Result<sim::TestCase> ParseCaseJson(const std::string& text, const std::string& file_name);
std::string WriteCaseJson(const sim::TestCase& test_case);

}  // namespace gauntlet::master
