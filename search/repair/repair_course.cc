#include "search/repair/repair_course.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "controllers/registry.h"
#include "search/failure_tally.h"
#include "sim/random/random_stream.h"

namespace gauntlet {
namespace {

constexpr double kFirstStep = 0.15;       // of a range
constexpr double kClearly = 0.1;          // fewer failures of a value alone, for the search to begin at it
constexpr std::size_t kGenerations = 16;  // that a large budget is spent on
constexpr std::size_t kFewestGenerations = 4;  // that a small one is, before candidates get fewer cases
constexpr std::size_t kEnoughCases = 15;       // of a candidate, where a budget is small
constexpr std::size_t kFewestCases = 6;        // of a candidate
constexpr std::size_t kGuardsOf = 3;           // one of so many cases of a candidate is a guard
constexpr double kFewContacts = 15.0;          // cases, in which half of what is too much is chance
constexpr std::size_t kBlocksOfCases = 3;   // of a generation's cases, between which candidates are dropped
constexpr std::size_t kFinalists = 8;       // of which the repaired settings are chosen
constexpr std::size_t kFewestJoining = 20;  // cases, in which it is seen whether values go together
constexpr std::uint64_t kPartOf = 6;  // the budget: kept for the choice; spent at most on what goes together
constexpr double kMoreTimeouts = 0.01;  // beside the original's share

double Mean(double sum, int count) {
  return count == 0 ? 0.0 : sum / count;
}

double MeanFitness(const RepairTally& tally) {
  return Mean(std::accumulate(tally.fitness.begin(), tally.fitness.end(), 0.0),
              static_cast<int>(tally.fitness.size()));
}

// The first `count` of them in an order that `seed` decides.
std::vector<std::size_t> Shuffled(std::size_t first, std::size_t count, std::uint64_t seed,
                                  std::uint32_t turn) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  sim::RandomStream random(seed, sim::StreamPurpose::kVariation, turn);
  for (std::size_t i = count; i > 1; --i)
    std::swap(numbers[i - 1], numbers[random.Below(static_cast<std::uint32_t>(i))]);
  return numbers;
}

}  // namespace

std::size_t RepairCases::held_out() const {
  return std::accumulate(units.begin(), units.end(), std::size_t{0});
}

std::uint64_t RepairPlan::RunsOfCurves() const {
  std::uint64_t values = 0;
  for (const VariedKey& key : varied) {
    const bool whole = key.key.type == KeyType::kInteger;
    const auto all = whole ? static_cast<std::size_t>(key.high - key.low) + 1 : kCurveValues;
    values += key.listed() ? key.values.size() : std::min(kCurveValues, all);
  }
  return values * std::min(cases.training, kCurveCases);
}

std::uint64_t RepairPlan::RunsOfProof() const {
  return kProofRuns * (2 * cases.training + (2 + 2 * varied.size()) * cases.held_out()) + 2 * cases.random;
}

Result<RepairPlan> MakeRepairPlan(const Experiment& experiment, std::span<const Key> keys, std::size_t cases,
                                  std::uint64_t seed) {
  const RepairSpec& spec = experiment.repair;
  RepairPlan plan{.runs = spec.runs, .seed = seed};
  TRY(plan.varied, ParseVariedKeys(Split(spec.vary, ' '), keys, experiment));
  for (const VariedKey& key : plan.varied) {
    const KeyValue& value = plan.original.emplace_back(key.key.get(experiment));
    const bool inside = key.listed() ? std::ranges::count(key.values, value) > 0
                                     : NumberOf(value) >= key.low && NumberOf(value) <= key.high;
    if (!inside)
      return InvalidInput(fmt::format("--vary {}: the controller has {}, which is not in this range",
                                      key.ToText(), ToSet(value)));
  }
  plan.cases.training = static_cast<std::size_t>(spec.training);
  plan.cases.guards = static_cast<std::size_t>(spec.guards);
  for (const std::string& text : Split(spec.units, ' ')) {
    if (const auto unit = ParseNumber<std::size_t>(text)) plan.cases.units.push_back(*unit);
  }
  if (plan.cases.training == 0 || plan.cases.first_random() > cases)
    return InvalidInput(
        fmt::format("a repair of {} training cases, {} guards and {} held-out ones is given {}",
                    plan.cases.training, plan.cases.guards, plan.cases.held_out(), Counted(cases, "case")));
  plan.cases.random = cases - plan.cases.first_random();
  if (const auto* scenario = controllers::FindScenario(experiment))
    plan.time_limit = scenario->TimeLimit(experiment.scenario_parameters);
  const std::size_t candidates = CmaEs(SettingsPoint(plan.varied.size(), 0.5), kFirstStep, 0).population();
  const std::size_t joining = std::min(plan.cases.first_held_out(), kFewestJoining);
  const std::size_t original = plan.cases.first_held_out();
  const std::size_t least = original + joining + (candidates + kFinalists) * kFewestCases;
  if (static_cast<std::size_t>(spec.runs) < least)
    return InvalidInput(
        fmt::format("--budget {}: at least {} runs are needed: the original controller in {} cases, "
                    "its best value alone in {}, and one generation",
                    spec.runs, least, original, joining));
  return plan;
}

void RepairTally::Add(const RepairTally& other) {
  runs += other.runs;
  failures += other.failures;
  without_result += other.without_result;
  timeouts += other.timeouts;
  counted += other.counted;
  fitness.insert(fitness.end(), other.fitness.begin(), other.fitness.end());
  effects.contacts += other.effects.contacts;
  effects.seconds += other.effects.seconds;
  effects.distance += other.effects.distance;
}

RepairCourse::RepairCourse(RepairPlan plan, std::string_view failing)
    : plan_(std::move(plan)),
      failing_(failing),
      cma_(PlaceOf(plan_.original), kFirstStep, plan_.seed),
      curves_(plan_.varied.size()),
      alone_(plan_.varied.size()),
      all_but_(plan_.varied.size()) {
  AddSetting(plan_.original);
}

SettingsPoint RepairCourse::PlaceOf(const std::vector<KeyValue>& values) const {
  SettingsPoint place;
  for (std::size_t i = 0; i < values.size(); ++i) place.push_back(plan_.varied[i].PlaceOf(values[i]));
  return place;
}

std::size_t RepairCourse::AddSetting(std::vector<KeyValue> values) {
  const auto known = std::ranges::find(settings_, values);
  if (known != settings_.end()) return static_cast<std::size_t>(known - settings_.begin());
  settings_.push_back(std::move(values));
  tallies_.emplace_back();
  return settings_.size() - 1;
}

std::size_t RepairCourse::AddRounded(const SettingsPoint& place) {
  std::vector<KeyValue> values;
  for (std::size_t i = 0; i < place.size(); ++i) values.push_back(plan_.varied[i].RoundedAt(place[i]));
  return AddSetting(std::move(values));
}

void RepairCourse::Tell(const SettingsRun& run, const RunOutcome& outcome) {
  RepairTally one{.runs = 1};
  if (!outcome.completed()) {
    one.failures = one.without_result = 1;
  } else {
    one.failures = Fails(outcome, failing_) ? 1 : 0;
    one.fitness = {outcome.fitness};
    one.timeouts = plan_.time_limit > 0.0 && outcome.effects.seconds >= plan_.time_limit ? 1 : 0;
    one.counted = outcome.effects.contacts >= 0.0 ? 1 : 0;
    one.effects = outcome.effects;
    one.effects.contacts = std::max(one.effects.contacts, 0.0);
  }
  tallies_[run.setting][run.of_case].Add(one);
}

RepairTally RepairCourse::TallyOf(std::size_t setting, std::size_t of_case) const {
  const auto found = tallies_[setting].find(of_case);
  return found == tallies_[setting].end() ? RepairTally() : found->second;
}

RepairTally RepairCourse::TallyOf(std::size_t setting, std::size_t first, std::size_t count) const {
  RepairTally sum;
  for (std::size_t i = 0; i < count; ++i) sum.Add(TallyOf(setting, first + i));
  return sum;
}

RepairTally RepairCourse::Sum(std::size_t setting, std::span<const std::size_t> cases) const {
  RepairTally sum;
  for (const std::size_t one : cases) sum.Add(TallyOf(setting, one));
  return sum;
}

double RepairCourse::ScoreOf(std::size_t setting, std::span<const std::size_t> cases) const {
  // What fails touches little or much by chance: side effects are looked at in the guards.
  std::vector<std::size_t> guards;
  std::ranges::copy_if(cases, std::back_inserter(guards),
                       [&](std::size_t one) { return one >= plan_.cases.training; });
  const RepairTally here = Sum(setting, guards);
  const RepairTally there = Sum(kOriginal, guards);
  double score = Sum(setting, cases).Share();
  const double most = kMoreContacts * Mean(there.effects.contacts, there.counted);
  if (most > 0.0 && here.counted > 0) {
    const double more = Mean(here.effects.contacts, here.counted) / most - 1.0;
    score += std::max(0.0, more) * here.counted / (here.counted + kFewContacts);
  }
  score += std::max(0.0, Mean(here.timeouts, here.runs) - Mean(there.timeouts, there.runs) - kMoreTimeouts);
  return score;
}

bool RepairCourse::Better(std::size_t one, std::size_t other, std::span<const std::size_t> cases) const {
  const double score = ScoreOf(one, cases);
  const double against = ScoreOf(other, cases);
  if (score != against) return score < against;
  const RepairTally a = Sum(one, cases);
  const RepairTally b = Sum(other, cases);
  return MeanFitness(a) > MeanFitness(b);
}

std::uint64_t RepairCourse::RunsOfGeneration() const {
  const std::size_t all = plan_.cases.training + plan_.cases.guards;
  const std::size_t left = static_cast<std::size_t>(plan_.runs) - all;
  const auto each = [&](std::size_t generations) { return left / ((generations + 1) * cma_.population()); };
  const std::size_t cases =
      std::max({kFewestCases, std::min(kEnoughCases, each(kFewestGenerations)), each(kGenerations)});
  return cma_.population() * std::min(all, cases);
}

void RepairCourse::BeginGeneration() {
  candidates_.clear();
  for (const SettingsPoint& place : cma_.Ask()) {
    std::vector<KeyValue> values;
    for (std::size_t i = 0; i < place.size(); ++i) values.push_back(plan_.varied[i].ValueAt(place[i]));
    candidates_.push_back(AddSetting(std::move(values)));
  }
  racing_ = candidates_;
  const std::size_t each = RunsOfGeneration() / cma_.population();
  const std::size_t guards = std::min(plan_.cases.guards, each / kGuardsOf);
  const std::size_t training = std::min(plan_.cases.training, each - guards);
  const auto turn = static_cast<std::uint32_t>(++generations_);
  const auto failed = Shuffled(0, plan_.cases.training, plan_.seed, 2 * turn);
  const auto random = Shuffled(plan_.cases.training, plan_.cases.guards, plan_.seed, 2 * turn + 1);
  cases_.clear();
  for (std::size_t i = 0; i < training; ++i) {
    cases_.push_back(failed[i]);
    const std::size_t wanted = (i + 1) * guards / training;
    while (cases_.size() - (i + 1) < wanted) cases_.push_back(random[cases_.size() - (i + 1)]);
  }
  simulated_ = 0;
}

std::vector<SettingsRun> RepairCourse::NextBlock() {
  const std::size_t end =
      std::min(cases_.size(), simulated_ + (cases_.size() + kBlocksOfCases - 1) / kBlocksOfCases);
  std::vector<SettingsRun> runs;
  for (const std::size_t setting : racing_) {
    for (std::size_t i = simulated_; i < end; ++i) runs.push_back({setting, cases_[i]});
  }
  simulated_ = end;
  searched_ += runs.size();
  return runs;
}

// Those that stay behind the better half even if they fail no more, and all others in all that is left.
void RepairCourse::DropHopeless() {
  const std::span<const std::size_t> seen(cases_.data(), simulated_);
  const auto left = static_cast<double>(cases_.size() - simulated_) / static_cast<double>(cases_.size());
  const double share = 1.0 - left;
  std::vector<double> worst;
  for (const std::size_t one : racing_) worst.push_back(ScoreOf(one, seen) * share + left);
  if (worst.size() <= cma_.parents()) return;
  std::ranges::nth_element(worst, worst.begin() + static_cast<std::ptrdiff_t>(cma_.parents()) - 1);
  const double bound = worst[cma_.parents() - 1];
  std::erase_if(racing_, [&](std::size_t one) { return ScoreOf(one, seen) * share > bound; });
}

void RepairCourse::EndGeneration() {
  std::vector<std::size_t> order(candidates_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto in_race = [&](std::size_t i) { return std::ranges::count(racing_, candidates_[i]) > 0; };
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    if (in_race(a) != in_race(b)) return in_race(a);
    return Better(candidates_[a], candidates_[b], cases_);
  });
  cma_.Tell(order);
  means_.push_back(cma_.mean());
}

std::vector<SettingsRun> RepairCourse::BeginChoice() {
  stage_ = Stage::kChoice;
  const auto consider = [&](std::size_t setting) {
    if (chosen_from_.size() < kFinalists && std::ranges::count(chosen_from_, setting) == 0)
      chosen_from_.push_back(setting);
  };
  // One value alone may do as well as all together, and is the simpler repair.
  const std::vector<std::size_t> cases = CurveCases();
  const auto alone = std::ranges::min_element(alone_, {}, [&](const std::optional<std::size_t>& one) {
    return one ? Sum(*one, cases).Share() : 1.0;
  });
  if (*alone) consider(**alone);
  consider(start_);
  for (auto mean = means_.rbegin(); mean != means_.rend(); ++mean) consider(AddRounded(*mean));
  const std::size_t all = plan_.cases.training + plan_.cases.guards;
  const auto left = static_cast<std::size_t>(plan_.runs) - std::min<std::size_t>(searched_, plan_.runs);
  const std::size_t each = std::min(all, std::max(kFewestCases, left / chosen_from_.size()));
  cases_ = Shuffled(0, all, plan_.seed, 0);
  cases_.resize(each);
  std::vector<SettingsRun> runs;
  for (const std::size_t setting : chosen_from_) {
    for (const std::size_t one : cases_) runs.push_back({setting, one});
  }
  searched_ += runs.size();
  return runs;
}

std::vector<std::size_t> RepairCourse::CurveCases() const {
  std::vector<std::size_t> cases = Shuffled(0, plan_.cases.training, plan_.seed, 1);
  cases.resize(std::min(cases.size(), RepairPlan::kCurveCases));
  return cases;
}

std::vector<SettingsRun> RepairCourse::BeginCurves() {
  stage_ = Stage::kCurves;
  std::vector<SettingsRun> runs;
  for (std::size_t key = 0; key < plan_.varied.size(); ++key) {
    const VariedKey& varied = plan_.varied[key];
    std::vector<KeyValue> values = varied.values;
    for (std::size_t i = 0; !varied.listed() && i < RepairPlan::kCurveValues; ++i) {
      const KeyValue value = varied.RoundedAt(static_cast<double>(i) / (RepairPlan::kCurveValues - 1));
      if (std::ranges::count(values, value) == 0) values.push_back(value);
    }
    for (const KeyValue& value : values) {
      std::vector<KeyValue> all = plan_.original;
      all[key] = value;
      const std::size_t setting = AddSetting(std::move(all));
      curves_[key].push_back(setting);
      if (setting == kOriginal) continue;
      for (const std::size_t one : CurveCases()) runs.push_back({setting, one});
    }
  }
  return runs;
}

// Each key's value that fails clearly less alone, its neighbours counted half; the best one first.
void RepairCourse::ReadCurves() {
  const std::vector<std::size_t> cases = CurveCases();
  const double clearly = Sum(kOriginal, cases).Share() - kClearly;
  std::vector<double> share(curves_.size());
  for (std::size_t key = 0; key < curves_.size(); ++key) {
    const std::vector<std::size_t>& curve = curves_[key];
    std::size_t best_alone = kOriginal;
    std::optional<std::size_t> best;
    share[key] = clearly;
    for (std::size_t i = 0; i < curve.size(); ++i) {
      if (Sum(curve[i], cases).Share() < Sum(best_alone, cases).Share()) best_alone = curve[i];
      double weight = 0.0;
      double sum = 0.0;
      for (std::size_t j = i == 0 ? 0 : i - 1; j < std::min(i + 2, curve.size()); ++j) {
        weight += j == i ? 1.0 : 0.5;
        sum += (j == i ? 1.0 : 0.5) * Sum(curve[j], cases).Share();
      }
      if (sum / weight >= share[key]) continue;
      share[key] = sum / weight;
      best = curve[i];
    }
    if (best_alone != kOriginal) alone_[key] = best_alone;
    if (best) joining_.push_back({key, settings_[*best][key]});
  }
  std::ranges::stable_sort(joining_, {}, [&](const auto& one) { return share[one.first]; });
  const std::size_t all = plan_.cases.first_held_out();
  const std::size_t each =
      static_cast<std::size_t>(plan_.runs) / kPartOf / std::max(joining_.size(), std::size_t{1});
  cases_ = Shuffled(0, all, plan_.seed, 0);
  cases_.resize(std::min(all, std::max(each, kFewestJoining)));
}

// One more of them joins where they do better together.
std::vector<SettingsRun> RepairCourse::JoinNext() {
  stage_ = Stage::kJoining;
  if (joined_ && ScoreOf(*joined_, cases_) < ScoreOf(start_, cases_)) start_ = *joined_;
  const auto most = static_cast<std::uint64_t>(plan_.runs) / kPartOf + plan_.cases.first_held_out();
  if (tried_ == joining_.size() || (joined_ && searched_ + cases_.size() > most)) {
    stage_ = Stage::kSearch;
    cma_ = CmaEs(PlaceOf(settings_[start_]), kFirstStep, plan_.seed);
    BeginGeneration();
    return NextBlock();
  }
  std::vector<KeyValue> values = settings_[start_];
  const auto& [key, value] = joining_[tried_++];
  values[key] = value;
  joined_ = AddSetting(std::move(values));
  std::vector<SettingsRun> runs;
  for (const std::size_t one : cases_) {
    if (TallyOf(*joined_, one).runs == 0) runs.push_back({*joined_, one});
  }
  searched_ += runs.size();
  return runs.empty() ? JoinNext() : runs;
}

std::vector<SettingsRun> RepairCourse::BeginProof() {
  stage_ = Stage::kProof;
  repaired_ = kOriginal;  // unless one is better
  for (const std::size_t one : chosen_from_) {
    if (Better(one, *repaired_, cases_)) repaired_ = one;
  }
  std::vector<std::size_t> in_all = {kOriginal};
  if (*repaired_ != kOriginal) in_all.push_back(*repaired_);
  std::vector<std::size_t> in_held_out = in_all;
  for (std::size_t key = 0; key < plan_.varied.size(); ++key) {
    std::vector<KeyValue> all_but = settings_[*repaired_];
    if (all_but[key] != plan_.original[key]) {
      all_but[key] = plan_.original[key];
      all_but_[key] = AddSetting(std::move(all_but));
    }
    for (const auto& one : {alone_[key], all_but_[key]}) {
      if (one && std::ranges::count(in_held_out, *one) == 0) in_held_out.push_back(*one);
    }
  }
  // What the search has seen of these counts no more.
  for (const std::size_t setting : in_all) {
    for (std::size_t i = 0; i < plan_.cases.training; ++i) tallies_[setting].erase(i);
  }
  std::vector<SettingsRun> runs;
  const auto ask = [&](std::size_t setting, std::size_t first, std::size_t count, std::size_t times) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t run = 0; run < times; ++run) runs.push_back({setting, first + i});
    }
  };
  for (const std::size_t setting : in_held_out)
    ask(setting, plan_.cases.first_held_out(), plan_.cases.held_out(), RepairPlan::kProofRuns);
  for (const std::size_t setting : in_all) {
    ask(setting, 0, plan_.cases.training, RepairPlan::kProofRuns);
    ask(setting, plan_.cases.first_random(), plan_.cases.random, 1);
  }
  return runs;
}

std::vector<SettingsRun> RepairCourse::Next() {
  ++stages_;
  switch (stage_) {
    case Stage::kStart: {
      stage_ = Stage::kBaseline;
      std::vector<SettingsRun> runs;
      for (std::size_t i = 0; i < plan_.cases.first_held_out(); ++i) runs.push_back({kOriginal, i});
      searched_ += runs.size();
      return runs;
    }
    case Stage::kBaseline:
      if (TallyOf(kOriginal, 0, plan_.cases.training).failures == 0) return BeginProof();
      return BeginCurves();
    case Stage::kCurves:
      ReadCurves();
      return JoinNext();
    case Stage::kJoining:
      return JoinNext();
    case Stage::kSearch: {
      DropHopeless();
      if (simulated_ < cases_.size()) return NextBlock();
      EndGeneration();
      const std::uint64_t choice = static_cast<std::uint64_t>(plan_.runs) / kPartOf;
      if (searched_ + RunsOfGeneration() + choice > static_cast<std::uint64_t>(plan_.runs))
        return BeginChoice();
      BeginGeneration();
      return NextBlock();
    }
    case Stage::kChoice:
      return BeginProof();
    case Stage::kProof:
      break;
  }
  --stages_;
  return {};
}

std::uint64_t RepairCourse::RunsPlanned() const {
  return static_cast<std::uint64_t>(plan_.runs) + plan_.RunsOfCurves() + plan_.RunsOfProof();
}

}  // namespace gauntlet
