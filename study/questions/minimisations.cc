// What `gauntlet minimise` asks: what is the smallest part of a case that still fails?
#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/figures/layout_strip.h"
#include "proto/json_text.h"
#include "proto/run_failure.h"
#include "search/given/case_minimiser.h"
#include "study/questions/question_table.h"
#include "study/questions/smallest_layouts.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

// A case whose runs were told.
struct Minimisation {
  const CaseAnswer& answer;
  CaseMinimiser minimiser;

  explicit Minimisation(const CaseAnswer& of)
      : answer(of), minimiser(of.test_case.obstacles, RulesOf(*of.experiment)) {
    TellAll(of, minimiser);
  }
  bool Left() const { return minimiser.outcome() == MinimisedTo::kLayout; }
  bool Smaller() const { return Left() && minimiser.steps().size() > 1; }
  std::size_t obstacles() const { return minimiser.layout().obstacles.size(); }
  const FailureTally& verified() const { return minimiser.verification().tally; }
  // The file that keeps what is left, without its ending.
  std::string File() const { return SmallestLayoutFile(answer.campaign, answer.name); }
};

std::string DescribeStep(const MinimisingStep& step) {
  using Change = MinimisingStep::Change;
  switch (step.change) {
    case Change::kNone:
      return "as it is";
    case Change::kNearest:
      return fmt::format("the {} nearest", step.layout.kept.size());
    case Change::kWithout:
      return fmt::format("without obstacle {}", step.obstacle + 1);
    case Change::kShortened:
      return fmt::format("obstacle {} made {:.1f} m long", step.obstacle + 1, step.length);
  }
  return "";
}

proto::CaseFailures FailuresOf(const FailureTally& tally) {
  const analysis::Interval interval = FailureInterval(tally);
  return {tally.failures, tally.runs(), {interval.low, interval.high}};
}

// What is left, with where it comes from.
std::string SmallestCase(const Minimisation& one) {
  proto::CaseDocument smallest{.test_case = one.answer.test_case, .lineage = proto::CaseLineage{}};
  smallest.test_case.obstacles = one.minimiser.layout().obstacles;
  smallest.test_case.name = fmt::format("{}, minimised", one.answer.name);
  proto::CaseLineage& lineage = *smallest.lineage;
  lineage.made_by = "minimise";
  lineage.failing = FailingOf(*one.answer.experiment);
  lineage.parent = one.answer.test_case;
  for (const MinimisingStep& step : one.minimiser.steps()) {
    proto::CaseStep& written = lineage.steps.emplace_back();
    written.change = DescribeStep(step);
    for (const std::size_t obstacle : step.layout.kept)
      written.obstacles.push_back(static_cast<int>(obstacle) + 1);
    written.found = FailuresOf(step.found);
  }
  lineage.verified = FailuresOf(one.verified());
  return proto::WriteCaseDocument(smallest);
}

std::string DrawSteps(const Minimisation& one) {
  const sim::TestCase& original = one.answer.test_case;
  const LayoutRuns& verified = one.minimiser.verification();
  analysis::LayoutStrip strip{.title = fmt::format("{}: from {} obstacles to {}", one.answer.name,
                                                   original.obstacles.size(), one.obstacles()),
                              .original = original,
                              .pictures = {},
                              .places = verified.places};
  for (const MinimisingStep& step : one.minimiser.steps()) {
    strip.pictures.push_back({.heading = DescribeStep(step),
                              .outcome = fmt::format("failed in {} runs", OutOf(step.found)),
                              .obstacles = step.layout.obstacles,
                              .kept = step.layout.kept});
  }
  strip.pictures.back().outcome = fmt::format("fails in {} fresh runs{}", OutOf(verified.tally),
                                              verified.places.empty() ? "" : ", at the dots");
  return analysis::DrawLayoutStrip(strip);
}

std::uint64_t KeyBesideSearch(const Experiment& about, const sim::TestCase& test_case) {
  return KeyOfCase(MinimisationOf(about, /*shorten=*/false), test_case);
}

// How often the case failed in all, with what `confirm` has seen of it; "" when nobody has asked that.
std::string WithConfirmation(const Minimisation& one, const std::string& dir) {
  auto known = AnswersOfCalls(FolderOf(ConfirmQuestion(), dir), KeyBesideSearch);
  if (!known) return "";
  const std::vector<CaseAnswer> best = BestOf(*std::move(known));
  const auto confirmed = std::ranges::find(
      best, KeyBesideSearch(*one.answer.experiment, one.answer.test_case), &CaseAnswer::key);
  if (confirmed == best.end()) return "";
  const FailureTally seen = confirmed->tally();
  const FailureTally& found = one.minimiser.original();
  return fmt::format(" (with what confirm saw: {} of {})", found.failures + seen.failures,
                     found.runs() + seen.runs());
}

// What became of a case that is not simply smaller now, in words.
std::string RemarkOn(const Minimisation& one, const std::string& dir) {
  switch (one.minimiser.outcome()) {
    case MinimisedTo::kOpen:
      return "open";
    case MinimisedTo::kNoFailure:
      return "not minimised: it does not fail often enough" + WithConfirmation(one, dir);
    case MinimisedTo::kError:
      return "not minimised: a run of it ended without a result: " + proto::Explained(one.answer.Message());
    case MinimisedTo::kEmpty:
      return fmt::format("not minimised: the EMPTY ARENA FAILS TOO, in {} runs",
                         OutOf(one.minimiser.empty()));
    case MinimisedTo::kLayout:
      break;
  }
  std::string remark = one.Smaller() ? "" : "no smaller part of it fails as reliably";
  if (!CaseMinimiser::IsReliable(one.verified()))
    remark += fmt::format("{}below the bar of {} in {} runs", remark.empty() ? "" : "; ",
                          CaseMinimiser::kVerifyingFailures, CaseMinimiser::kVerifyingRuns);
  return remark;
}

Json CountsJson(const FailureTally& tally) {
  return {{"k", tally.failures}, {"n", tally.runs()}};
}

void AddRow(const Minimisation& one, const std::string& remark, Table& table) {
  const CaseAnswer& answer = one.answer;
  Json original = {{"obstacles", answer.test_case.obstacles.size()}};
  original.update(CountsJson(one.minimiser.original()));
  Json left;  // null: refused
  std::string which;
  const analysis::Interval interval = FailureInterval(one.verified());
  if (one.Left()) {
    left = {{"obstacles", one.obstacles()}};
    left.update(CountsJson(one.verified()));
    left["interval"] = {interval.low, interval.high};
    left["case"] = Json::parse(SmallestCase(one));
    left["files"] = {one.File() + ".json", one.File() + ".svg"};
    for (const std::size_t kept : one.minimiser.steps().back().layout.kept)
      which += fmt::format("{}{}", which.empty() ? "" : " ", kept + 1);
  }
  table.AddRow({answer.run > 0 ? Cell(answer.run) : Cell(), answer.name,
                JsonCell(std::move(original), OutOf(one.minimiser.original())),
                answer.test_case.obstacles.size(), JsonCell(CountsJson(one.minimiser.empty())),
                JsonCell(std::move(left), one.Left() ? fmt::format("{}", one.obstacles()) : "-"), which,
                one.Left() ? OutOf(one.verified()) : "-", one.Left() ? PercentCell(interval) : Cell(""),
                answer.runs.size(), one.Left() && one.minimiser.SameFailures(one.minimiser.verification()),
                remark});
}

Result<Told> TellMinimisations(const Asking& asking, const Call& /*call*/,
                               std::span<const CaseAnswer> answers) {
  Told told{.conclusion = Conclusion::kRefused};
  Table table({ForPrograms("run"),
               {"case", "name"},
               {">failed", "original"},
               {">obstacles"},
               ForPrograms("empty_arena"),
               {">left", "minimised"},
               {"which"},
               {">fails"},
               {"probability (95 %)"},
               {">runs", "simulations"},
               ForPrograms("kept_same_way"),
               {"", "remark"}});
  for (const CaseAnswer& answer : answers) {
    const Minimisation one(answer);
    AddRow(one, RemarkOn(one, asking.place), table);
    if (!one.Left()) continue;
    told.conclusion = Conclusion::kDone;
    std::string picture = DrawSteps(one);
    const std::string what = fmt::format("what is left, for '{} evaluate EXPERIMENT --case'", asking.program);
    told.files.push_back({one.File() + ".json", SmallestCase(one), one.Smaller() ? what : ""});
    told.files.push_back({one.File() + ".svg", picture, one.Smaller() ? "how it came about" : ""});
    if (!one.Smaller()) continue;
    told.section.pictures.push_back({"How the case was made smaller",
                                     "Each picture takes something away, and the swarm still fails in the "
                                     "same way.",
                                     std::move(picture)});
  }
  told.json = JsonText({{"cases", table.ToJson()}});
  told.section.table = std::move(table);
  return told;
}

Result<Experiment> AboutMinimisation(const Experiment& experiment, const Asking& asking) {
  return MinimisationOf(experiment, asking.Has("--shorten"));
}

constexpr const char* kMinimiseHelp =
    R"(Takes obstacles away for as long as the swarm still fails in the same way. A case has to fail again with
fresh seeds first ('gauntlet confirm' says how often), and the arena without obstacles must not. Where the
scenario knows the place of a failure (flocking: the last split), the nearest obstacles are tried first; then
each is left out in turn, until none can be spared. A step is taken when runs prefer a failure probability of
.95 to .75; what is left must fail in 24 of 30 more runs that took no part in choosing it, else a step is taken
back.

What is left is kept below DIR/minimise: a case file that says how it came about, and a picture of each step.
A case that was minimised before is not simulated again. Exit 2 when every case was refused. After Ctrl-C or a
kill the same command goes on.

Examples:
  gauntlet minimise DIR 812
  gauntlet minimise DIR 812 817 --json | jq '.cases[0].minimised.case' > smallest.json
  gauntlet evaluate flocking --case smallest.json --replicates 100)";

}  // namespace

Question MinimiseQuestion() {
  return {.name = "minimise",
          .summary = "the smallest part of a case that still breaks the swarm",
          .help = kMinimiseHelp,
          .options = {{"--shorten", "", "make the obstacles that are left shorter too",
                       QuestionOption::Kind::kFlag}},
          .cases = CasesWithObstacles,
          .about = AboutMinimisation,
          .tell = TellMinimisations,
          .page_title = "What is left of it"};
}

}  // namespace gauntlet
