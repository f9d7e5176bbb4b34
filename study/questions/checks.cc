// What `gauntlet check` asks: do the cases of a corpus still break the controller?
#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "master/directory/plugins.h"
#include "proto/json_text.h"
#include "proto/run_failure.h"
#include "proto/run_text.h"
#include "search/cases/corpus_file.h"
#include "search/given/repeated_case.h"
#include "study/questions/corpus_experiment.h"
#include "study/questions/question_table.h"

namespace gauntlet {
namespace {

enum class CheckOutcome {
  kAsExpected,
  kBetter,  // it fails less than expected
  kWorse,   // more; or a run ended without a result
};

// A case of the corpus, and what came of it.
struct CheckedCase {
  CorpusEntry entry;
  CaseAnswer answer;
  FailureTally tally = answer.tally();
  FailureVerdict verdict = VerdictOf(tally, /*replicates=*/0);
  CheckOutcome outcome = CheckOutcome::kAsExpected;
};

// The place in kExpectations: the greater, the worse.
std::ptrdiff_t Badness(std::string_view verdict) {
  return std::ranges::find(kExpectations, verdict) - std::begin(kExpectations);
}

CheckOutcome OutcomeOf(const CheckedCase& checked) {
  if (checked.verdict == FailureVerdict::kError) return CheckOutcome::kWorse;
  const std::ptrdiff_t seen = Badness(NameOf(checked.verdict));
  const std::ptrdiff_t expected = Badness(checked.entry.content.expected);
  if (seen == expected) return CheckOutcome::kAsExpected;
  return seen > expected ? CheckOutcome::kWorse : CheckOutcome::kBetter;
}

std::size_t Count(const std::vector<CheckedCase>& cases, CheckOutcome outcome) {
  return static_cast<std::size_t>(std::ranges::count(cases, outcome, &CheckedCase::outcome));
}

std::string RemarkOn(const CheckedCase& one) {
  if (one.verdict == FailureVerdict::kError) return "NO RESULT: " + proto::Explained(one.answer.Message());
  switch (one.outcome) {
    case CheckOutcome::kAsExpected:
      return "";
    case CheckOutcome::kBetter:
      return "better";
    case CheckOutcome::kWorse:
      return one.entry.content.expected == "pass" ? "FAILS AGAIN" : "WORSE";
  }
  return "";
}

// The first run that failed, or ended without a result; 0 = none did.
RunId FirstToSee(const CaseAnswer& answer) {
  const auto run =
      std::ranges::find(answer.runs, 0, [](const CaseRun& one) { return one.became.tally.passes; });
  return run == answer.runs.end() ? 0 : run->id;
}

std::string XmlText(const std::string& text) {
  std::string escaped;
  for (const char c : Printable(text)) {
    const std::string_view entity = c == '&'   ? "&amp;"
                                    : c == '<' ? "&lt;"
                                    : c == '>' ? "&gt;"
                                    : c == '"' ? "&quot;"
                                               : std::string_view(&c, 1);
    escaped += entity;
  }
  return escaped;
}

// JUnit's XML: a case that is worse than expected is a failure, one without a result an error.
std::string JunitOf(const std::string& name, const std::vector<CheckedCase>& cases) {
  const auto errors = std::ranges::count(cases, FailureVerdict::kError, &CheckedCase::verdict);
  const std::string suite = XmlText(name);
  std::string xml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuites>\n<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\">\n",
      suite, cases.size(),
      std::ssize(cases) - errors -
          std::ranges::count_if(cases, [](const auto& one) { return one.outcome != CheckOutcome::kWorse; }),
      errors);
  for (const CheckedCase& one : cases) {
    xml += fmt::format("<testcase classname=\"{}\" name=\"{}\"", suite, XmlText(one.answer.name));
    if (one.outcome != CheckOutcome::kWorse) {
      xml += "/>\n";
      continue;
    }
    const bool error = one.verdict == FailureVerdict::kError;
    const std::string message = error ? one.answer.Message()
                                      : fmt::format("fails in {} runs with fresh seeds, expected: {}",
                                                    OutOf(one.tally), one.entry.content.expected);
    xml += fmt::format("><{0} message=\"{1}\">{2}</{0}></testcase>\n", error ? "error" : "failure",
                       XmlText(message), XmlText(one.entry.file));
  }
  return xml + "</testsuite>\n</testsuites>\n";
}

// Lines of a diff between what a file says and what it is to say.
std::string DiffOf(const CorpusCase& before, const CorpusCase& after) {
  std::string diff;
  const auto compare = [&](const std::string& key, const std::string& was, const std::string& is) {
    if (was == is) return;
    if (!was.empty()) diff += fmt::format("-{}: {}\n", key, was);
    if (!is.empty()) diff += fmt::format("+{}: {}\n", key, is);
  };
  compare("expected", before.expected, after.expected);
  for (const auto& [key, value] : before.settings) compare("experiment." + key, value, SettingOf(after, key));
  for (const auto& [key, value] : after.settings) {
    if (SettingOf(before, key).empty()) compare("experiment." + key, "", value);
  }
  return diff;
}

// Writes what was seen, and with which settings, into the files; tells what changes.
void Update(const Asking& asking, const std::vector<CheckedCase>& cases, Told& told) {
  told.details = "\n";
  for (const CheckedCase& one : cases) {
    if (one.verdict == FailureVerdict::kError) continue;
    CorpusCase after = one.entry.content;
    after.expected = NameOf(one.verdict);
    if (asking.Has("--set")) after.settings = SettingsOf(*one.answer.experiment);
    const std::string diff = DiffOf(one.entry.content, after);
    if (diff.empty()) continue;
    told.details += fmt::format("--- {0}\n+++ {0}\n{1}", one.entry.file, diff);
    told.files.push_back({one.entry.file, WriteCorpusCase(after), "", /*replaces=*/true});
  }
  told.messages.push_back(fmt::format("{} of {} files changed", told.files.size(), cases.size()));
}

// One search for each different experiment.
Result<Call> PlanCheck(const Asking& asking) {
  TRY(const std::vector<CorpusEntry> entries, ReadCorpus(asking.place));
  TRY(const std::vector<std::string> plugins, AddPluginFiles(asking.Values("--plugin")));
  Call call{.anew = true};  // the controller's code may have changed since
  std::map<std::vector<std::pair<std::string, std::string>>, std::size_t> search_of;
  Fnv1a64 hash;
  for (const CorpusEntry& entry : entries) {
    TRY(const Experiment experiment, ExperimentOf(entry, asking.Values("--set"), plugins));
    const auto about = std::make_shared<const Experiment>(CheckOf(experiment));
    const std::string& name = entry.content.name;
    const auto [search, is_new] = search_of.try_emplace(SettingsOf(experiment), call.searches.size());
    if (is_new) call.searches.push_back({fmt::format("settings of {}", name), *about});
    sim::TestCase test_case = entry.content.document.test_case;
    test_case.name = name;
    const std::uint64_t key = KeyOfCase(*about, test_case);
    hash.AddUint64(key);
    call.searches[search->second].cases.push_back(test_case);
    call.cases.push_back({.name = name,
                          .search = search->second,
                          .test_case = std::move(test_case),
                          .experiment = about,
                          .key = key});
  }
  if (call.searches.size() == 1) call.searches.front().settings.clear();
  call.directory = fmt::format("{}/{:016x}", FolderOf(CheckQuestion(), asking.place), hash.value());
  return call;
}

Result<Told> TellCheck(const Asking& asking, const Call& call, std::span<const CaseAnswer> answers) {
  TRY(const std::vector<CorpusEntry> entries, ReadCorpus(asking.place));
  std::vector<CheckedCase> cases;
  for (const CaseAnswer& answer : answers) {
    const auto entry =
        std::ranges::find(entries, answer.name, [](const CorpusEntry& one) { return one.content.name; });
    if (entry == entries.end())
      return Error{ErrorKind::kNotFound, fmt::format("{}: '{}' is gone", asking.place, answer.name)};
    CheckedCase& one = cases.emplace_back(CheckedCase{*entry, answer});
    one.outcome = OutcomeOf(one);
  }
  Table table({{"case", "name"},
               {"expected", "expected"},
               {">failed", "k n"},
               {"probability (95 %)", "interval"},
               {"now", "verdict"},
               ForPrograms("outcome"),
               {""},
               ForPrograms("message?")});
  const Experiment& experiment = *answers.front().experiment;
  Told told;
  for (const CheckedCase& one : cases) {
    table.AddRow({one.answer.name, one.entry.content.expected,
                  OutOfCell(one.tally.failures, one.tally.runs()), PercentCell(FailureInterval(one.tally)),
                  NameOf(one.verdict),
                  one.outcome == CheckOutcome::kWorse    ? "worse"
                  : one.outcome == CheckOutcome::kBetter ? "better"
                                                         : "as expected",
                  RemarkOn(one), TextCell(one.answer.Message())});
    const RunId run = FirstToSee(one.answer);
    if (one.outcome == CheckOutcome::kWorse && run > 0)
      told.section.commands.push_back(
          {fmt::format("{} replay {} {} --svg {}.svg", asking.program, PastedPath(call.directory),
                       proto::RunText(run), PastedPath(one.answer.name)),
           "see what happened"});
  }
  const std::size_t worse = Count(cases, CheckOutcome::kWorse);
  const std::size_t better = Count(cases, CheckOutcome::kBetter);
  told.json = JsonText({{"corpus", asking.place},
                        {"scenario", experiment.scenario},
                        {"controller", experiment.controller},
                        {"campaign", call.directory},
                        {"cases", table.ToJson()},
                        {"failed", worse},
                        {"passed", cases.size() - worse}});
  told.section.lead = {
      fmt::format("{}: {} with the controller {}", asking.place, experiment.scenario, experiment.controller)};
  told.section.table = std::move(table);
  const std::string sum = worse == 0 ? fmt::format("{0} of {0} cases as expected or better", cases.size())
                                     : fmt::format("{} of {} cases WORSE than expected", worse, cases.size());
  told.section.sentences = {
      sum + (better > 0 ? fmt::format("; {} better: --update expects that from now on.", better) : ".")};
  told.outputs["--junit"] = JunitOf(experiment.scenario + "." + experiment.controller, cases);
  bool negative = worse > 0;
  if (asking.Has("--update")) {
    Update(asking, cases, told);
    negative = std::ranges::count(cases, FailureVerdict::kError, &CheckedCase::verdict) > 0;
  }
  told.conclusion = negative ? Conclusion::kNegative : Conclusion::kDone;
  return told;
}

constexpr const char* kCheckHelp =
    R"(The regression suite of a controller. Every case is simulated with fresh seeds until it has failed 5 times
or not failed 6 times (at most 10 runs). What comes of it, fail (in at least half of the runs), flaky (in
fewer) or pass (in none), is held against what the case's file expects; exit 1 when a case is worse than
expected or a run ended without a result. The same controller gets the same seeds, so the outcome changes only
with the controller. A case that was added is expected to fail until it is mended: then --update writes "pass"
into its file, and the case that fails again is found.

A check that was stopped or killed goes on with the same command; the runs are in CORPUS/.check.

Examples:
  gauntlet check corpus
  gauntlet check corpus --set controller=flocking-improved
  gauntlet check corpus --set controller=flocking-improved --update
  gauntlet check corpus --junit check.xml --json)";

}  // namespace

Question CheckQuestion() {
  using Kind = QuestionOption::Kind;
  return {.name = "check",
          .summary = "do the cases of a corpus still break the controller?",
          .help = kCheckHelp,
          .place = Question::Place::kCorpus,
          .options = {{"--set", "KEY=VALUE",
                       "check with this setting instead of the files': controller=..., "
                       "controller_parameters.NAME=...",
                       Kind::kValues},
                      {"--plugin", "", "", Kind::kPlugins},
                      {"--junit", "F", "write the outcome as JUnit's XML", Kind::kOutput},
                      {"--update", "",
                       "expect from now on what was seen, with the settings of --set; prints what changes",
                       Kind::kFlag}},
          .plan = PlanCheck,
          .tell = TellCheck};
}

}  // namespace gauntlet
