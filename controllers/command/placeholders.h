// What a program is told of its run: its arguments, and the file with its test case.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "controllers/command/definition.h"
#include "sim/run_spec.h"

namespace gauntlet::controllers::command {

// Files in the run's folder.
inline constexpr const char* kOutFile = "out.json";
// Beside the trajectory, with this after its name, a replay may leave one with more rows, which is drawn.
inline constexpr const char* kReplayEnding = ".replay";
// What the environment of a replay says besides.
inline constexpr const char* kReplayVariable = "GAUNTLET_REPLAY=1";
std::string CaseFileOf(const Definition& definition);  // "case.json", "case.argos" of a template x.argos

// What {seed} stands for: 1 to 2^31 - 1.
std::uint32_t SeedOf(std::uint64_t seed);

// What is wrong with an argument's placeholders: {case}, {out}, {seed}, {seed64} and {parameters.NAME} are
// there, and "{{" stands for a brace. Nothing: ok.
Status CheckArgument(const Definition& definition, const std::string& argument);
// Those of the run, with every placeholder replaced. A placeholder never splits an argument.
std::vector<std::string> ArgumentsOf(const Definition& definition, const sim::RunSpec& spec);

// A template: text in which @seed@, @seed64@, @parameters.NAME@ and, between a line with @obstacles@ and one
// with @end@, which is repeated for each obstacle, @x@, @y@, @length@, @width@, @half_length@, @half_width@
// (m), @degrees@, @radians@ and @number@ (from 1 on) are replaced. Error: the marks are missing or a name is
// unknown, with the line.
Status CheckTemplate(const Definition& definition, std::string_view text);
std::string FillTemplate(const Definition& definition, std::string_view text, const sim::RunSpec& spec);

}  // namespace gauntlet::controllers::command
