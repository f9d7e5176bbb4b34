// gauntlet adopt: somebody's ARGoS project, as it is, becomes an experiment.
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/parse_number.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "cli/adopt/adoption.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "proto/json_text.h"

namespace gauntlet {
namespace {

constexpr std::size_t kShownScores = 8;

struct AdoptOptions {
  std::string argos_file;
  std::string output;
  std::string length;
  std::string height;
  std::string record;
  std::string score;
  bool check = false;
  bool json = false;
  bool quiet = false;
};

// Leaves the default where nothing was said.
Status ReadNumber(const char* option, const std::string& text, double least, double& number) {
  if (text.empty()) return Ok{};
  const auto given = ParseNumber<double>(text);
  if (!given || !(*given >= least && *given <= 1e6))
    return InvalidInput(
        fmt::format("{} {}: expected a number from {} to 1000000", option, Printable(text), least));
  number = *given;
  return Ok{};
}

std::vector<std::string> LinesOf(const std::vector<ArgosRemark>& remarks) {
  std::vector<std::string> lines;
  for (const ArgosRemark& remark : remarks) lines.push_back(remark.element + ": " + remark.meaning);
  return lines;
}

void PrintList(CommandContext& context, const char* title, const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  context.out << title << "\n";
  for (const std::string& line : lines) context.out << "  " << Printable(line) << "\n";
}

void PrintText(CommandContext& context, const AdoptOptions& options, const Adopted& adopted) {
  PrintList(context, "Taken over", adopted.taken_over);
  PrintList(context, "Different in runs", LinesOf(adopted.differs));
  PrintList(context, "Not taken over", LinesOf(adopted.unsupported));
  std::vector<std::string> scores;
  for (const ScoreCandidate& one : adopted.scores) {
    if (scores.size() < kShownScores)
      scores.push_back(fmt::format("{}: {} without obstacles, {} with another seed, {} with an obstacle",
                                   one.from, one.first, one.other_seed, one.with_obstacle));
  }
  PrintList(context, "Scores that were seen (--score)", scores);
  context.out << fmt::format("Two runs with one seed {}.\nThe score is {}; a run takes {:.1f} s.\n",
                             adopted.reproducible ? "are equal" : "differ", Printable(adopted.score),
                             adopted.seconds);
  context.out << fmt::format("Gauntlet's own engine {}.\n", Printable(adopted.engine.said));
  if (!options.check)
    context.out << fmt::format("\n  {} evolve {}\n", context.program, PastedPath(options.output));
}

nlohmann::json ListOf(const std::vector<ArgosRemark>& remarks) {
  nlohmann::json list = nlohmann::json::array();
  for (const ArgosRemark& remark : remarks)
    list.push_back({{"element", remark.element}, {"meaning", remark.meaning}});
  return list;
}

nlohmann::json DocumentOf(const AdoptOptions& options, const Adopted& adopted) {
  nlohmann::json scores = nlohmann::json::array();
  for (const ScoreCandidate& one : adopted.scores)
    scores.push_back(
        {{"from", one.from}, {"values", {one.first, one.other_seed}}, {"with_obstacle", one.with_obstacle}});
  return {{"taken_over", adopted.taken_over},
          {"differs", ListOf(adopted.differs)},
          {"unsupported", ListOf(adopted.unsupported)},
          {"scores", scores},
          {"score", adopted.score},
          {"reproducible", adopted.reproducible},
          {"libraries", adopted.libraries},
          {"engine",
           {{"compiles", adopted.engine.compiles},
            {"cases", adopted.engine.cases},
            {"seconds", adopted.engine.seconds},
            {"robots", adopted.engine.robots},
            {"near", adopted.engine.near},
            {"apart", adopted.engine.apart},
            {"apart_at_end", adopted.engine.apart_at_end},
            {"trusted", adopted.engine.trusted},
            {"said", adopted.engine.said}}},
          {"seconds", adopted.seconds},
          {"experiment", options.check ? nlohmann::json(nullptr) : nlohmann::json(options.output)}};
}

Result<ExitCode> RunAdopt(CommandContext& context, const AdoptOptions& options) {
  if (options.output.empty() && !options.check)
    return InvalidInput("where to? say -o NAME.toml, or --check to write nothing");
  AdoptionOptions adoption{.argos_file = options.argos_file,
                           .experiment = options.check ? "" : options.output,
                           .score = options.score,
                           .form = {}};
  TRY(ReadNumber("--length", options.length, 0.1, adoption.form.length));
  TRY(ReadNumber("--height", options.height, 0.001, adoption.form.height));
  TRY(ReadNumber("--record", options.record, 0.0, adoption.form.every));
  const auto say = [&](const std::string& message) {
    if (!options.quiet) PrintMessage(context, message);
  };
  TRY(const Adopted adopted, Adopt(adoption, say, context.err));
  if (options.json) {
    context.out << JsonText(DocumentOf(options, adopted));
  } else {
    PrintText(context, options, adopted);
  }
  context.out << std::flush;
  return kExitDone;
}

}  // namespace

void AddAdopt(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("adopt", "make an experiment of an ARGoS project, which runs in ARGoS itself", RunAdopt);
  command.add_option("FILE.argos", options.argos_file, "the project's experiment, as argos3 runs it")
      ->required();
  AddValue(command, "-o,--output", "NAME.toml", options.output,
           "the experiment to write; what it needs is written beside it, into NAME.adopted");
  AddValue(command, "--length", "S", options.length, "how long a run is (default: as the file says)");
  AddValue(command, "--score", "WHERE", options.score,
           "log:PATTERN, csv:FILE:COLUMN or a measure of positions such as displacement (default: the first "
           "that is seen)");
  AddValue(command, "--height", "M", options.height, "height of obstacles (default: 0.5)");
  AddValue(command, "--record", "S", options.record,
           "time between recorded positions; 0 = each tick (default: 1)");
  command.add_flag("--check", options.check, "run the project and tell what was seen; write nothing");
  command.add_flag("--json", options.json, "print the result as one JSON document");
  command.add_flag("--quiet", options.quiet, "print no messages, except errors");
  command.footer(
      R"(Runs the project 13 times: once in a copy, to see what it writes and which libraries it loads, then as the
experiment will run it, to see what is usual (7 times where a run takes over 10 s). Call it where you call argos3, with the same environment. Nothing is written into the project.
Exit 2 when the project does not run, or when a box in the robots' way changes nothing. docs/from-argos.md goes through
an example.

Examples:
  gauntlet adopt experiments/foraging.argos -o foraging.toml --length 300
  gauntlet adopt my.argos -o my.toml --score 'log:items: (\d+)'
  gauntlet adopt my.argos --check --json)");
}

}  // namespace gauntlet
