#include "study/repairs/repair_result.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "master/campaign/stored_campaign.h"
#include "master/campaign/stored_search.h"
#include "proto/json_text.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastGain = 0.05;        // of held-out failure probability, below which nothing is mended
constexpr std::size_t kFewestJudges = 10;  // held-out cases, below which nothing is shown
constexpr double kNoEffect = 0.03;         // a change of failure probability that is told as none
constexpr double kMatters = 0.1;           // one that is told as an effect of the parameter alone
constexpr double kAtBound = 0.02;          // of the range
constexpr double kLowerFitness = 0.44;  // A, from where on the effect is told (1 - kVarghaDelaney2000.small)
constexpr std::size_t kMostNamedCases = 8;

struct Range {
  std::size_t first = 0;
  std::size_t count = 0;
};

Range HeldOut(const Repair& repair) {
  const RepairCases& cases = repair.plan().cases;
  return {cases.first_held_out(), cases.held_out()};
}

double ShareIn(const Repair& repair, std::size_t setting, Range range) {
  return repair.course().TallyOf(setting, range.first, range.count).Share();
}

std::optional<RepairChange> ChangeIn(const Repair& repair, Range range, std::vector<std::size_t> units = {}) {
  return ChangeOf(repair.course(), range.first, range.count, std::move(units));
}

bool FailsMostly(const Repair& repair, std::size_t setting, std::size_t of_case) {
  return repair.course().TallyOf(setting, of_case).Share() > 0.5;
}

// Held-out cases that fail with the original and no longer with `setting`.
std::vector<std::size_t> MendedBy(const Repair& repair, std::size_t setting) {
  std::vector<std::size_t> mended;
  const Range range = HeldOut(repair);
  for (std::size_t one = range.first; one < range.first + range.count; ++one) {
    if (FailsMostly(repair, RepairCourse::kOriginal, one) && !FailsMostly(repair, setting, one))
      mended.push_back(one);
  }
  return mended;
}

// All settings that were simulated in held-out cases.
std::vector<std::size_t> JudgedSettings(const Repair& repair) {
  std::vector<std::size_t> settings = {*repair.course().repaired()};
  for (std::size_t key = 0; key < repair.plan().varied.size(); ++key) {
    for (const auto& one : {repair.course().AloneOf(key), repair.course().AllButOf(key)}) {
      if (one && std::ranges::count(settings, *one) == 0) settings.push_back(*one);
    }
  }
  return settings;
}

// Held-out cases that fail with the original and with all that was tried.
std::vector<std::size_t> NeverMended(const Repair& repair) {
  std::vector<std::size_t> never;
  const Range range = HeldOut(repair);
  const std::vector<std::size_t> settings = JudgedSettings(repair);
  for (std::size_t one = range.first; one < range.first + range.count; ++one) {
    const auto fails = [&](std::size_t setting) { return FailsMostly(repair, setting, one); };
    if (fails(RepairCourse::kOriginal) && std::ranges::all_of(settings, fails)) never.push_back(one);
  }
  return never;
}

std::string NamesOf(const Repair& repair, const std::vector<std::size_t>& cases) {
  std::vector<std::string> names;
  for (const std::size_t one : cases) {
    if (names.size() < kMostNamedCases) names.push_back(repair.cases[one].name);
  }
  const std::string rest =
      cases.size() > kMostNamedCases ? fmt::format(" and {} more", cases.size() - kMostNamedCases) : "";
  return fmt::format("{}{}", fmt::join(names, ", "), rest);
}

std::string ShareText(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

Cell ShareCell(double share) {
  return {ShareText(share), share};
}

std::string IntervalText(const analysis::Interval& interval) {
  return fmt::format("{:.1f} to {:.1f} %", 100.0 * interval.low, 100.0 * interval.high);
}

std::string ValueText(const KeyValue& value) {
  const auto* number = std::get_if<double>(&value);
  return number == nullptr ? ToSet(value) : fmt::format("{:.4g}", *number);
}

std::string ShortName(const VariedKey& key) {
  return key.key.path.substr(key.key.path.rfind('.') + 1);
}

Table ChangeTable(const Repair& repair) {
  Table table({{"cases", "cases"},
               {">number", "number"},
               {">failing before", "before"},
               {"95 %", "before_interval"},
               {">after", "after"},
               {"95 %", "after_interval"},
               {">fewer by", "fewer"},
               {"95 %", "fewer_interval"},
               {">A", "a"}});
  const auto a = [](double value) { return Cell(fmt::format("{:.2f}", value), value); };
  const auto add = [&](const char* what, const std::optional<RepairChange>& change) {
    if (!change) return;
    const auto interval = [](const analysis::Interval& one) {
      return Cell(IntervalText(one), std::make_shared<const Json>(Json{one.low, one.high}));
    };
    table.AddRow({what, change->cases, ShareCell(change->before), interval(change->before_interval),
                  ShareCell(change->after), interval(change->after_interval), ShareCell(change->less),
                  interval(change->less_interval), a(change->a)});
  };
  add("held out", ChangeInHeldOut(repair));
  add("random", ChangeInRandom(repair));
  add("training", ChangeInTraining(repair));
  for (const FreshSearch& fresh : repair.fresh) {
    const auto share = [](const FreshSearch::Found& found) {
      return static_cast<double>(found.failures) /
             static_cast<double>(std::max<std::uint64_t>(found.runs, 1));
    };
    const double before = share(fresh.before);
    const double after = share(fresh.after);
    table.AddRow({"anew, " + fresh.title, fresh.after.runs, ShareCell(before), Cell(), ShareCell(after),
                  Cell(), ShareCell(before - after), Cell(),
                  a(FitnessA(fresh.before.fitness, fresh.after.fitness))});
  }
  return table;
}

Table KeysTable(const Repair& repair) {
  Table table({{"parameter", "key"},
               {">original", "original"},
               {">repaired", "repaired"},
               {">alone", "alone"},
               {">failing alone", "failing_alone"},
               {">failing without", "failing_without"},
               {">mends alone", "mended_alone"},
               {"", "flags"}});
  for (const RepairedKey& one : KeysOf(repair)) {
    const auto value = [](const KeyValue& held) {
      const auto* number = std::get_if<double>(&held);
      return Cell(ValueText(held), number == nullptr ? Value(ToSet(held)) : Value(*number));
    };
    table.AddRow({ShortName(one.key), value(one.original), value(one.repaired),
                  one.alone ? value(*one.alone) : Cell(), ShareCell(one.failing_alone),
                  ShareCell(one.failing_without), one.mended_alone,
                  Cell(fmt::format("{}", fmt::join(one.flags, ", ")))});
  }
  return table;
}

// In all cases that judge.
RepairTally JudgedTally(const Repair& repair, std::size_t setting) {
  const RepairCases& cases = repair.plan().cases;
  return repair.course().TallyOf(setting, cases.first_held_out(), cases.held_out() + cases.random);
}

double ContactsIn(const RepairTally& tally) {
  return tally.counted == 0 ? 0.0 : tally.effects.contacts / tally.counted;
}

Table EffectsTable(const Repair& repair) {
  Table table({{"in each run", "effect"}, {">before", "before"}, {">after", "after"}});
  const RepairTally before = JudgedTally(repair, RepairCourse::kOriginal);
  const RepairTally after = JudgedTally(repair, *repair.course().repaired());
  const auto add = [&](const char* what, auto value) {
    const auto mean = [&](const RepairTally& one) {
      const double number = value(one) / std::max(one.runs - one.without_result, 1);
      return Cell(fmt::format("{:.3g}", number), number);
    };
    table.AddRow({what, mean(before), mean(after)});
  };
  if (before.counted > 0) add("contacts", [](const RepairTally& one) { return one.effects.contacts; });
  add("simulated time, s", [](const RepairTally& one) { return one.effects.seconds; });
  if (before.effects.distance > 0.0)
    add("distance driven by all robots, m", [](const RepairTally& one) { return one.effects.distance; });
  if (repair.plan().time_limit > 0.0)
    add("runs to the time limit, share", [](const RepairTally& one) { return double(one.timeouts); });
  return table;
}

// "turning_speed_factor: 0.5 to 0.97 alone mends 31 of 40 held-out cases; ..."
std::string FaultText(const Repair& repair) {
  const std::vector<RepairedKey> keys = KeysOf(repair);
  const auto most = std::ranges::max_element(keys, {}, &RepairedKey::mended_alone);
  const std::size_t failing = HeldOut(repair).count;
  if (failing == 0 || most->mended_alone == 0) return "No parameter alone mends a held-out case.";
  int second = 0;
  for (const RepairedKey& one : keys) {
    if (&one != &*most) second = std::max(second, one.mended_alone);
  }
  return fmt::format(
      "{}: {} to {} alone mends {} of {} held-out cases; no other parameter alone mends more than {}.",
      ShortName(most->key), ValueText(most->original), ValueText(*most->alone), most->mended_alone, failing,
      second);
}

// What the searches that began anew have found.
std::vector<std::string> FreshSentences(const Repair& repair) {
  std::vector<std::string> sentences;
  for (const FreshSearch& fresh : repair.fresh) {
    if (fresh.archive && fresh.before.cells + fresh.after.cells > 0)
      sentences.push_back(fmt::format("The archive search fills {} of its cells, {} against the original.",
                                      fresh.after.cells, fresh.before.cells));
  }
  if (!repair.fresh.empty())
    sentences.push_back(
        "Anew: one search against either, whose number is that of its runs; as these depend on each "
        "other, there is no interval.");
  return sentences;
}

std::vector<std::string> Warnings(const Repair& repair) {
  std::vector<std::string> warnings;
  const auto held_out = ChangeInHeldOut(repair);
  const auto training = ChangeInTraining(repair);
  const bool judged = held_out && training && held_out->cases >= kFewestJudges;
  if (judged && held_out->less < training->less / 2.0)
    warnings.push_back(
        fmt::format("Overfitted: failures are fewer by {} in training cases and by {} in held-out ones.",
                    ShareText(training->less), ShareText(held_out->less)));
  if (const auto random = ChangeInRandom(repair); random && random->less_interval.high < 0.0)
    warnings.push_back(
        fmt::format("In random cases it fails more often than before, by {}.", ShareText(-random->less)));
  if (const auto random = ChangeInRandom(repair); random && random->a < kLowerFitness)
    warnings.push_back(
        fmt::format("In random cases it fails less and yet does less: of two runs, one before and one "
                    "after, the later has the lower fitness in {}.",
                    ShareText(1.0 - random->a)));
  const double before = ContactsIn(JudgedTally(repair, RepairCourse::kOriginal));
  const double after = ContactsIn(JudgedTally(repair, *repair.course().repaired()));
  if (after > RepairCourse::kMoreContacts * before)
    warnings.push_back(
        fmt::format("Its robots touch more often: {:.3g} times in each run, {:.3g} before.", after, before));
  return warnings;
}

}  // namespace

Result<Repair> ReadRepair(const std::string& dir) {
  TRY(const StoredCampaign campaign, OpenStoredCampaign(dir));
  ResultStore& store = *campaign.view.store;
  const SearchPlan& plan = campaign.plans.front();
  TRY(std::shared_ptr<SearchAlgorithm> search, MakeStoredSearch(plan, store));
  TRY(RestoreSearch(plan.id, store, *search));
  if (search->Repair() == nullptr) return InvalidInput(dir + " holds no repair: gauntlet repair makes one");
  Repair repair{.experiment = plan.experiment, .search = search};
  repair.finished = search->Progress().finished && search->Repair()->repaired().has_value();
  TRY(repair.fresh, ReadFreshSearches(dir));
  for (const Individual& one : search->Population()) repair.cases.push_back(one.test_case);
  return repair;
}

std::optional<RepairChange> ChangeInHeldOut(const Repair& repair) {
  return ChangeIn(repair, HeldOut(repair), repair.plan().cases.units);
}

std::optional<RepairChange> ChangeInTraining(const Repair& repair) {
  return ChangeIn(repair, {0, repair.plan().cases.training});
}

std::optional<RepairChange> ChangeInRandom(const Repair& repair) {
  const RepairCases& cases = repair.plan().cases;
  return ChangeIn(repair, {cases.first_random(), cases.random});
}

std::vector<RepairedKey> KeysOf(const Repair& repair) {
  const RepairCourse& course = repair.course();
  const std::size_t repaired = *course.repaired();
  const Range held_out = HeldOut(repair);
  const double before = ShareIn(repair, RepairCourse::kOriginal, held_out);
  const double after = ShareIn(repair, repaired, held_out);
  std::vector<RepairedKey> keys;
  for (std::size_t i = 0; i < repair.plan().varied.size(); ++i) {
    const VariedKey& varied = repair.plan().varied[i];
    RepairedKey& key = keys.emplace_back(RepairedKey{.key = varied,
                                                     .original = course.ValuesOf(RepairCourse::kOriginal)[i],
                                                     .repaired = course.ValuesOf(repaired)[i]});
    key.failing_alone = before;
    key.failing_without = after;
    if (const auto alone = course.AloneOf(i)) {
      key.alone = course.ValuesOf(*alone)[i];
      key.failing_alone = ShareIn(repair, *alone, held_out);
      key.mended_alone = static_cast<int>(MendedBy(repair, *alone).size());
    }
    if (const auto without = course.AllButOf(i)) key.failing_without = ShareIn(repair, *without, held_out);
    const double place = varied.PlaceOf(key.repaired);
    const bool helps_alone = before - key.failing_alone >= kMatters;
    const bool missed = key.failing_without - after > kNoEffect;
    if (!varied.listed() && (place <= kAtBound || place >= 1.0 - kAtBound) && key.repaired != key.original)
      key.flags.push_back("at a bound of its range");
    if (!helps_alone && std::abs(key.failing_without - after) <= kNoEffect)
      key.flags.push_back("without effect");
    if (helps_alone && !missed && repair.course().repaired() != RepairCourse::kOriginal)
      key.flags.push_back("made up for by others");
  }
  return keys;
}

bool IsMended(const Repair& repair) {
  const auto change = ChangeInHeldOut(repair);
  return change && change->cases >= kFewestJudges && change->less >= kLeastGain &&
         change->less_interval.low > 0.0;
}

std::vector<RepairLevel> RepairCurve(const Repair& repair, std::size_t key) {
  std::vector<RepairLevel> levels;
  for (const std::size_t setting : repair.course().CurveOf(key)) {
    RepairTally tally;
    for (const std::size_t one : repair.course().CurveCases())
      tally.Add(repair.course().TallyOf(setting, one));
    if (tally.runs > 0)
      levels.push_back({repair.course().ValuesOf(setting)[key], tally.runs, tally.failures});
  }
  return levels;
}

Table RepairCurveTable(const Repair& repair, std::size_t key) {
  Table table(
      {{">" + repair.plan().varied[key].key.path, "value"}, {">failed", "failures"}, {">runs", "runs"}});
  for (const RepairLevel& level : RepairCurve(repair, key))
    table.AddRow({ValueText(level.value), level.failures, level.runs});
  return table;
}

std::string OutcomeOf(const Repair& repair) {
  if (!repair.finished) return "The repair has not come to its end.";
  const auto change = ChangeInHeldOut(repair);
  if (!change) return "No held-out case judges whether it is mended.";
  const std::string by =
      fmt::format("held-out failures are {} by {} ({}, 95 %)", change->less < 0.0 ? "more" : "fewer",
                  ShareText(std::abs(change->less)), IntervalText(change->less_interval));
  if (const auto training = ChangeInTraining(repair); training && training->before == 0.0)
    return "Nothing to repair: the controller does not fail in the training cases.";
  if (change->cases < kFewestJudges)
    return fmt::format("Not shown either way: {}, and {} are too few to judge by; {} are needed.", by,
                       Counted(change->cases, "case"), kFewestJudges);
  if (IsMended(repair))
    return fmt::format(
        "Mended: of held-out runs {} fail with the repaired parameters, {} with the original ones.",
        ShareText(change->after), ShareText(change->before));
  if (change->less >= kLeastGain) return fmt::format("Not shown to be mended: {}, which may be chance.", by);
  double alone = change->before;
  for (const RepairedKey& key : KeysOf(repair)) alone = std::min(alone, key.failing_alone);
  return fmt::format(
      "Not mended by its parameters: {}. {}",
      repair.course().repaired() == RepairCourse::kOriginal
          ? "no settings that were tried fail less in the training cases, without more contacts "
            "or time-outs than allowed"
          : by + ", which is less than 5 %",
      change->before - alone < kMatters ? "Its rules have to change."
                                        : "One of them alone does better, which fresh cases have to judge.");
}

Experiment RepairedExperiment(const Repair& repair) {
  Experiment repaired = WithValues(repair.experiment, repair.plan().varied,
                                   repair.course().ValuesOf(*repair.course().repaired()));
  repaired.search.algorithm = repaired.repair.search;
  repaired.repair = {};
  repaired.name += "-repaired";
  return repaired;
}

std::string RepairedToml(const Repair& repair, const std::string& dir) {
  return WriteExperiment(
      RepairedExperiment(repair),
      {fmt::format("{}, repaired by gauntlet repair in the campaign {}.", repair.experiment.name, dir),
       OutcomeOf(repair)},
      BuiltInCatalogue());
}

std::vector<Section> TellRepair(const Repair& repair, const std::string& dir, const std::string& program) {
  const std::string place = PastedPath(dir);
  Section proof{.title = "Repair of " + repair.experiment.controller};
  const RepairCases& cases = repair.plan().cases;
  proof.lead = {fmt::format(
      "{} in {} of {}, over {} that failed and {} random ones; judged in cases that took no part.",
      Counted(repair.course().searched(), "run"), Counted(repair.course().generations(), "generation"),
      Counted(repair.plan().varied.size(), "parameter"), Counted(cases.training, "training case"),
      cases.guards)};
  if (!repair.finished) {
    proof.sentences = {OutcomeOf(repair)};
    proof.commands = {{fmt::format("{} resume {}", program, place), "go on"}};
    return {std::move(proof)};
  }
  proof.table = ChangeTable(repair);
  proof.sentences = {OutcomeOf(repair), FaultText(repair)};
  std::ranges::move(FreshSentences(repair), std::back_inserter(proof.sentences));
  std::ranges::move(Warnings(repair), std::back_inserter(proof.sentences));
  const std::vector<std::size_t> never = NeverMended(repair);
  if (!never.empty())
    proof.sentences.push_back(fmt::format(
        "None of the {} settings that were tried in held-out cases mends {} of them, which need other "
        "rules: {}.",
        JudgedSettings(repair).size(), never.size(), NamesOf(repair, never)));
  Section keys{.title = "The parameters"};
  keys.table = KeysTable(repair);
  keys.sentences = {
      "Alone: the value of nine that failed least in training, all others original. Without: all "
      "repaired but this one. Both are judged in the held-out cases."};
  Section effects{.title = "Side effects"};
  effects.table = EffectsTable(repair);
  effects.commands = {
      {fmt::format("{} check {}/corpus --update", program, place),
       "what its cases are expected to do comes from three runs: look again with fresh seeds"}};
  if (repair.fresh.empty() && repair.experiment.repair.fresh > 0) {
    effects.commands.push_back({fmt::format("{} repair {}", program, place), "search anew against it"});
  } else {
    effects.commands.push_back({fmt::format("{} evolve {}/repaired.toml", program, place),
                                "search longer for what still breaks the repaired controller"});
  }
  return {std::move(proof), std::move(keys), std::move(effects)};
}

std::string RepairJson(const Repair& repair, const std::string& dir) {
  Json json({{"directory", dir},
             {"finished", repair.finished},
             {"runs", repair.course().searched()},
             {"generations", repair.course().generations()}});
  if (!repair.finished) return JsonText(json);
  json["mended"] = IsMended(repair);
  json["outcome"] = OutcomeOf(repair);
  json["fault"] = FaultText(repair);
  json["warnings"] = Warnings(repair);
  for (const FreshSearch& fresh : repair.fresh) {
    if (fresh.archive) json["cells"] = {{"before", fresh.before.cells}, {"after", fresh.after.cells}};
  }
  json["changes"] = ChangeTable(repair).ToJson();
  json["parameters"] = KeysTable(repair).ToJson();
  json["side_effects"] = EffectsTable(repair).ToJson();
  Json never = Json::array();
  for (const std::size_t one : NeverMended(repair)) never.push_back(repair.cases[one].name);
  json["never_mended"] = std::move(never);
  return JsonText(json);
}

}  // namespace gauntlet
