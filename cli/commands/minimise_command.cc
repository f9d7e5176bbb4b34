// gauntlet minimise: the smallest part of a case that still breaks the swarm.
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/figures/layout_strip.h"
#include "analysis/tables/table.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "cli/commands.h"
#include "cli/given_cases.h"
#include "cli/output/output_file.h"
#include "proto/json_text.h"
#include "proto/run_failure.h"
#include "study/questions/answered_calls.h"
#include "study/questions/minimisations.h"
#include "study/questions/smallest_layouts.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

struct MinimiseOptions : RunningOptions {
  std::string directory;
  std::vector<std::string> cases;
  bool shorten = false;
};

// What became of a case that is not simply smaller now, in words.
std::string Remark(const Minimisation& one) {
  switch (one.outcome) {
    case MinimisedTo::kOpen:
      return "open";
    case MinimisedTo::kNoFailure:
      return "not minimised: it does not fail often enough";
    case MinimisedTo::kError:
      return "not minimised: a run of it ended without a result: " + Printable(proto::Explained(one.message));
    case MinimisedTo::kEmpty:
      return fmt::format("not minimised: the EMPTY ARENA FAILS TOO, in {} runs", OutOf(one.empty));
    case MinimisedTo::kLayout:
      break;
  }
  std::string remark = one.Smaller() ? "" : "no smaller part of it fails as reliably";
  if (!CaseMinimiser::IsReliable(one.verified.tally))
    remark += fmt::format("{}below the bar of {} in {} runs", remark.empty() ? "" : "; ",
                          CaseMinimiser::kVerifyingFailures, CaseMinimiser::kVerifyingRuns);
  return remark;
}

// The file that keeps what is left, without its ending.
std::string FileOf(const Minimisation& one) {
  return SmallestLayoutFile(one.directory, one.name);
  return "";
}

analysis::LayoutStrip StripOf(const Minimisation& one) {
  analysis::LayoutStrip strip{
      .title = fmt::format("{}: from {} obstacles to {}", one.name, one.original.obstacles.size(),
                           one.smallest.test_case.obstacles.size()),
      .original = one.original,
      .pictures = {},
      .places = one.verified.places};
  for (const MinimisingStep& step : one.steps) {
    strip.pictures.push_back({.heading = DescribeStep(step),
                              .outcome = fmt::format("failed in {} runs", OutOf(step.found)),
                              .obstacles = step.layout.obstacles,
                              .kept = step.layout.kept});
  }
  strip.pictures.back().outcome = fmt::format("fails in {} fresh runs{}", OutOf(one.verified.tally),
                                              one.verified.places.empty() ? "" : ", at the dots");
  return strip;
}

std::string TextOf(const CommandContext& context, const std::vector<Minimisation>& cases) {
  Table table(
      {"case", ">failed", ">obstacles", ">left", "which", ">fails", "probability (95 %)", ">runs", ""});
  std::string files;
  for (const Minimisation& one : cases) {
    const std::string obstacles = fmt::format("{}", one.original.obstacles.size());
    if (one.outcome != MinimisedTo::kLayout) {
      table.AddRow({Printable(one.name), OutOf(one.found), obstacles, "-", "", "-", "",
                    fmt::format("{}", one.runs), Remark(one)});
      continue;
    }
    std::string which;
    for (const std::size_t kept : one.steps.back().layout.kept)
      which += fmt::format("{}{}", which.empty() ? "" : " ", kept + 1);
    table.AddRow({Printable(one.name), OutOf(one.found), obstacles,
                  fmt::format("{}", one.smallest.test_case.obstacles.size()), which,
                  OutOf(one.verified.tally),
                  fmt::format("{:3.0f} to {:3.0f} %", 100.0 * one.interval.low, 100.0 * one.interval.high),
                  fmt::format("{}", one.runs), Remark(one)});
    if (!one.Smaller()) continue;
    files +=
        fmt::format("  {}\n  {}\n", ShellQuoted(FileOf(one) + ".json"), ShellQuoted(FileOf(one) + ".svg"));
  }
  std::string text = table.ToText();
  if (files.empty()) return text;
  return text + fmt::format("\nWhat is left, for '{} evaluate EXPERIMENT --case', and how it came about:\n{}",
                            context.program, files);
}

Json JsonOf(const std::vector<Minimisation>& cases) {
  Json list = Json::array();
  for (const Minimisation& one : cases) {
    Json minimised;  // null: refused
    if (one.outcome == MinimisedTo::kLayout) {
      minimised = {{"obstacles", one.smallest.test_case.obstacles.size()},
                   {"k", one.verified.tally.failures},
                   {"n", one.verified.tally.runs()},
                   {"interval", {one.interval.low, one.interval.high}},
                   {"case", Json::parse(proto::WriteCaseDocument(one.smallest))}};
      minimised["files"] = {FileOf(one) + ".json", FileOf(one) + ".svg"};
    }
    const Json original = {
        {"obstacles", one.original.obstacles.size()}, {"k", one.found.failures}, {"n", one.found.runs()}};
    list.push_back({{"run", one.run > 0 ? Json(one.run) : Json()},
                    {"name", one.name},
                    {"original", original},
                    {"empty_arena", {{"k", one.empty.failures}, {"n", one.empty.runs()}}},
                    {"minimised", std::move(minimised)},
                    {"simulations", one.runs},
                    {"kept_same_way", one.same_way},
                    {"remark", Remark(one)}});
  }
  return {{"cases", std::move(list)}};
}

// What is there already stays: the campaign may be somebody's who may only read it.
Status KeepFiles(const Minimisation& one) {
  std::error_code none;
  if (one.outcome != MinimisedTo::kLayout || std::filesystem::exists(FileOf(one) + ".svg", none)) return Ok{};
  Status written = WriteOutputFile(FileOf(one) + ".json", proto::WriteCaseDocument(one.smallest));
  return written ? WriteOutputFile(FileOf(one) + ".svg", DrawLayoutStrip(StripOf(one))) : written;
}

// Prints and keeps what is left; kExitUsage when every case was refused.
Result<ExitCode> Conclude(CommandContext& context, const MinimiseOptions& options,
                          const QuestionedCampaign& questioned) {
  TRY(const std::vector<Minimisation> known, ReadMinimisations(options.directory));
  const std::vector<Minimisation> cases = AnswersTo(questioned, options.shorten, known);
  for (const Minimisation& one : cases) {
    TRY(KeepFiles(one));
  }
  context.out << (options.json ? JsonText(JsonOf(cases)) : TextOf(context, cases)) << std::flush;
  const bool any =
      std::ranges::any_of(cases, [](const Minimisation& one) { return one.outcome == MinimisedTo::kLayout; });
  return any ? kExitDone : kExitUsage;
}

Result<ExitCode> RunMinimise(CommandContext& context, const MinimiseOptions& options) {
  TRY(const int workers, ParseWorkers(options.workers));
  TRY(const QuestionedCampaign questioned, GivenCases(context, options.directory, options.cases));
  TRY(CheckHaveObstacles(questioned));
  TRY(const std::vector<Minimisation> known, ReadMinimisations(options.directory));
  const CallPlan plan = PlanMinimisation(options.directory, questioned, options.shorten, known);
  if (plan.searches.empty()) return Conclude(context, options, questioned);
  CampaignRun campaign = RunOfCall(context, plan, workers, options);
  ExitCode concluded = kExitDone;
  campaign.report = [&](const SessionReport& report) -> Status {
    if (report.end == CampaignEnd::kStopped) return Ok{};
    TRY(concluded, Conclude(context, options, questioned));
    return Ok{};
  };
  TRY(const ExitCode code, RunCampaign(context, campaign));
  return code == kExitDone ? concluded : code;
}

}  // namespace

void AddMinimise(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("minimise", "the smallest part of a case that still breaks the swarm", RunMinimise);
  AddDirectory(command, options.directory);
  command.add_option("CASE", options.cases, "runs of the campaign whose cases are meant, or case files")
      ->required();
  command.add_flag("--shorten", options.shorten, "make the obstacles that are left shorter too");
  AddRunningOptions(command, options);
  command.footer(
      R"(Takes obstacles away for as long as the swarm still fails in the same way. A case has to fail again with
fresh seeds first ('gauntlet confirm' says how often), and the arena without obstacles must not. Where the
scenario knows the place of a failure (flocking: the last split), the nearest obstacles are tried first; then
each is left out in turn, until none can be spared. A step is taken when runs prefer a failure probability of .95 to .75; what is left
must fail in 24 of 30 more runs that took no part in choosing it, else a step is taken back.

What is left is kept below DIR/minimise: a case file that says how it came about, and pictures of its way.
A case that was minimised before is not simulated again. Exit 2 when every case was refused. After Ctrl-C or a
kill the same command goes on.

Examples:
  gauntlet minimise DIR 812
  gauntlet minimise DIR 812 817 --json | jq '.cases[0].minimised.case' > smallest.json
  gauntlet evaluate flocking --case smallest.json --replicates 100)");
}

}  // namespace gauntlet
