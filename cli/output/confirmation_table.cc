#include "cli/output/confirmation_table.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/tables/table.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "proto/run_failure.h"
#include "report/tables/distinct_failures.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostFailures = 20;  // that are listed

// "run 8, minimised to 2 obstacles, fails in 24 of 30 runs".
std::string DescribeSmallest(const SmallestLayout& smallest) {
  const std::size_t obstacles = smallest.document.test_case.obstacles.size();
  const proto::CaseFailures& verified = smallest.document.lineage->verified;
  return fmt::format("run {}, minimised to {} obstacle{}, fails in {} of {} runs", smallest.run, obstacles,
                     obstacles == 1 ? "" : "s", verified.failures, verified.runs);
}

}  // namespace

std::string ConfirmationsText(const std::vector<Confirmation>& confirmations, std::size_t most) {
  Table table({"case", ">failed", "probability (95 %)", "verdict", ""});
  for (const Confirmation& one : std::span(confirmations).first(std::min(most, confirmations.size()))) {
    table.AddRow({Printable(one.name), fmt::format("{} of {}", one.tally.failures, one.tally.runs()),
                  fmt::format("{:3.0f} to {:3.0f} %", 100.0 * one.interval.low, 100.0 * one.interval.high),
                  std::string(NameOf(one.verdict)), Printable(proto::Explained(one.message))});
  }
  const auto confirmed = std::ranges::count(confirmations, FailureVerdict::kFail, &Confirmation::verdict);
  std::string text = table.ToText();
  if (confirmations.size() > most) {
    text += fmt::format("  and {} more; see show --json\n", confirmations.size() - most);
  }
  const auto files = std::ranges::count(confirmations, RunId{0}, &Confirmation::run);
  const std::string of_files =
      files == 0 ? "" : fmt::format(" ({} from {})", files, files == 1 ? "a file" : "files");
  return fmt::format(
      "{}{} of {} cases{} confirmed: with fresh seeds they fail in at least half of the runs.\n", text,
      confirmed, confirmations.size(), of_files);
}

nlohmann::ordered_json ConfirmationsJson(const std::vector<Confirmation>& confirmations) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Confirmation& one : confirmations) {
    list.push_back({{"run", one.run > 0 ? nlohmann::ordered_json(one.run) : nlohmann::ordered_json()},
                    {"case", one.name},
                    {"k", one.tally.failures},
                    {"n", one.tally.runs()},
                    {"interval", {one.interval.low, one.interval.high}},
                    {"verdict", NameOf(one.verdict)}});
    if (!one.message.empty()) list.back()["message"] = one.message;
  }
  return list;
}

std::string DistinctFailuresText(const CampaignAnswers& answers, const std::string& program) {
  std::string text = ToText(TellDistinctFailures(answers, kMostFailures, program));
  std::size_t told = 0;
  for (const DistinctFailure& one : DistinctFailures(answers.confirmations, answers.smallest_layouts)) {
    if (told++ == kMostFailures) break;
    if (one.smallest != nullptr)
      text += fmt::format("  {}: {}\n", DescribeSmallest(*one.smallest), PastedPath(one.smallest->file));
  }
  return text;
}

}  // namespace gauntlet
