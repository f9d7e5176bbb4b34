#include "cli/output/check_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/tables/table.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "proto/json_text.h"
#include "proto/run_failure.h"
#include "search/cases/corpus_file.h"

namespace gauntlet {
namespace {

// The place in kExpectations: the greater, the worse.
std::ptrdiff_t Badness(std::string_view verdict) {
  return std::ranges::find(kExpectations, verdict) - std::begin(kExpectations);
}

std::string Remark(const CheckedCase& one) {
  if (one.verdict == FailureVerdict::kError) return "NO RESULT: " + Printable(proto::Explained(one.message));
  switch (OutcomeOf(one)) {
    case CheckOutcome::kAsExpected:
      return "";
    case CheckOutcome::kBetter:
      return "better";
    case CheckOutcome::kWorse:
      return one.expected == "pass" ? "FAILS AGAIN" : "WORSE";
  }
  return "";
}

std::string XmlText(const std::string& text) {
  std::string escaped;
  for (const char c : Printable(text)) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string FailedIn(const CheckedCase& one) {
  return fmt::format("{} of {}", one.tally.failures, one.tally.runs());
}

}  // namespace

CheckOutcome OutcomeOf(const CheckedCase& checked) {
  if (checked.verdict == FailureVerdict::kError) return CheckOutcome::kWorse;
  const std::ptrdiff_t seen = Badness(NameOf(checked.verdict));
  const std::ptrdiff_t expected = Badness(checked.expected);
  if (seen == expected) return CheckOutcome::kAsExpected;
  return seen > expected ? CheckOutcome::kWorse : CheckOutcome::kBetter;
}

int CorpusReport::Count(CheckOutcome outcome) const {
  return static_cast<int>(
      std::ranges::count(cases, outcome, [](const CheckedCase& one) { return OutcomeOf(one); }));
}

std::string CheckText(const CorpusReport& report, const std::string& program) {
  Table table({"case", "expected", ">failed", "probability (95 %)", "now", ""});
  std::string to_see;
  for (const CheckedCase& one : report.cases) {
    table.AddRow({Printable(one.name), one.expected, FailedIn(one),
                  fmt::format("{:3.0f} to {:3.0f} %", 100.0 * one.interval.low, 100.0 * one.interval.high),
                  std::string(NameOf(one.verdict)), Remark(one)});
    if (OutcomeOf(one) != CheckOutcome::kWorse || one.run == 0) continue;
    to_see += fmt::format("  {} replay {} {} --svg {}.svg\n", program, PastedPath(report.campaign), one.run,
                          PastedPath(one.name));
  }
  const int worse = report.Count(CheckOutcome::kWorse);
  const int better = report.Count(CheckOutcome::kBetter);
  std::string text = fmt::format("{}: {} with the controller {}\n\n{}\n", Printable(report.corpus),
                                 report.scenario, report.controller, table.ToText());
  text += worse == 0
              ? fmt::format("{} of {} cases as expected or better", report.cases.size(), report.cases.size())
              : fmt::format("{} of {} cases WORSE than expected", worse, report.cases.size());
  text += better > 0 ? fmt::format("; {} better: --update expects that from now on.\n", better) : ".\n";
  return to_see.empty() ? text : text + "\nTo see what happened\n" + to_see;
}

std::string CheckJson(const CorpusReport& report) {
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  for (const CheckedCase& one : report.cases) {
    const CheckOutcome outcome = OutcomeOf(one);
    cases.push_back({{"name", one.name},
                     {"expected", one.expected},
                     {"k", one.tally.failures},
                     {"n", one.tally.runs()},
                     {"interval", {one.interval.low, one.interval.high}},
                     {"verdict", NameOf(one.verdict)},
                     {"outcome", outcome == CheckOutcome::kWorse    ? "worse"
                                 : outcome == CheckOutcome::kBetter ? "better"
                                                                    : "as expected"}});
    if (!one.message.empty()) cases.back()["message"] = one.message;
  }
  const int failed = report.Count(CheckOutcome::kWorse);
  return JsonText({{"corpus", report.corpus},
                   {"scenario", report.scenario},
                   {"controller", report.controller},
                   {"campaign", report.campaign},
                   {"cases", std::move(cases)},
                   {"failed", failed},
                   {"passed", static_cast<int>(report.cases.size()) - failed}});
}

std::string CheckJunit(const CorpusReport& report) {
  const auto errors = std::ranges::count(report.cases, FailureVerdict::kError, &CheckedCase::verdict);
  const std::string suite = XmlText(report.scenario + "." + report.controller);
  std::string xml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuites>\n<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\">\n",
      suite, report.cases.size(), report.Count(CheckOutcome::kWorse) - errors, errors);
  for (const CheckedCase& one : report.cases) {
    xml += fmt::format("<testcase classname=\"{}\" name=\"{}\"", suite, XmlText(one.name));
    if (OutcomeOf(one) != CheckOutcome::kWorse) {
      xml += "/>\n";
      continue;
    }
    const bool error = one.verdict == FailureVerdict::kError;
    const std::string message =
        error ? one.message
              : fmt::format("fails in {} runs with fresh seeds, expected: {}", FailedIn(one), one.expected);
    xml += fmt::format("><{0} message=\"{1}\">{2}</{0}></testcase>\n", error ? "error" : "failure",
                       XmlText(message), XmlText(one.file));
  }
  return xml + "</testsuite>\n</testsuites>\n";
}

}  // namespace gauntlet
