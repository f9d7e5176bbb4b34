#include "search/fit/fit_search.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/number_text.h"
#include "controllers/registry.h"
#include "controllers/run_start.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

// Rules between keys, and whether a swarm can begin, depend on these alone.
bool HasRules(std::span<const VariedKey> varied) {
  return std::ranges::any_of(varied, [](const VariedKey& one) {
    constexpr std::array<std::string_view, 3> kTables = {"genome.", "arena.", "scenario_parameters."};
    return std::ranges::any_of(kTables, [&](auto table) { return one.key.path.starts_with(table); });
  });
}

// Why no swarm begins with these settings, as far as can be told at once: a plug-in's process answers only
// for settings that are simulated.
Status CheckBegins(const Experiment& experiment) {
  if (const auto broken = CheckRules(experiment, BuiltInCatalogue())) return InvalidInput(broken->message);
  if (!experiment.scenario_plugin.empty()) return Ok{};
  const sim::TestCase empty = EmptyArena(experiment.arena);
  TRY(controllers::RequirementsOf(SpecOf(experiment, empty, experiment.seed)));
  return CheckSwarmFits(experiment, empty);
}

FitPosterior::Allowed BreaksNoRule(const Experiment& experiment, const FitPlan& plan) {
  if (!HasRules(plan.varied)) return [](const SettingsPoint&) { return true; };
  return [experiment, varied = plan.varied](const SettingsPoint& place) {
    return CheckBegins(WithValues(experiment, varied, FitSetting{.place = place}.ValuesOf(varied))).ok();
  };
}

int RunsOn(const FitPlan& plan, std::size_t cases, bool judged) {
  return judged ? plan.judged[cases] : plan.runs[cases];
}

}  // namespace

FitSearch::FitSearch(const SearchSetup& setup, FitPlan plan)
    : PopulationSearch(setup),
      rounds_(plan, search_seed_, BreaksNoRule(setup.experiment, plan)),
      reader_(rounds_.plan().targets, *controllers::FindScenario(setup.experiment)) {
  for (const sim::TestCase& test_case : setup.cases)
    newborns_.push_back(population_.emplace_back(MakeIndividual(++born_, test_case)));
}

Result<std::unique_ptr<FitSearch>> FitSearch::Create(const SearchSetup& setup) {
  TRY(FitPlan plan, MakeFitPlan(setup.experiment, AllKeysOf(setup.experiment)));
  std::size_t given = 0;
  for (const FitCases& cases : plan.cases) given = std::max(given, cases.last);
  if (setup.cases.size() < given)
    return InvalidInput(
        fmt::format("a target is about {}, and {} are given", Counted(given, "case"), setup.cases.size()));
  SearchSetup own = setup;
  own.cases.resize(given);  // those that a store has behind them belong to settings
  std::unique_ptr<FitSearch> search(new FitSearch(own, std::move(plan)));
  TRY(search->CheckSomeBegin());
  return search;
}

Status FitSearch::CheckSomeBegin() {
  const std::vector<VariedKey>& varied = rounds_.plan().varied;
  const SettingsPoint middle(varied.size(), 0.5);
  Status begins =
      CheckBegins(WithValues(setup_.experiment, varied, FitSetting{.place = middle}.ValuesOf(varied)));
  for (const SettingsPoint& place : rounds_.Propose()) {
    const Result<Beginning> beginning = BeginningOf({.place = place});
    if (beginning.ok()) return Ok{};
    begins = beginning.error();
  }
  return InvalidInput("no setting of the ranges can be simulated: " +
                      (begins.ok() ? "there are none" : begins.error().message));
}

Result<FitSearch::Beginning> FitSearch::BeginningOf(const FitSetting& setting) const {
  const std::vector<VariedKey>& varied = rounds_.plan().varied;
  auto experiment =
      std::make_shared<const Experiment>(WithValues(setup_.experiment, varied, setting.ValuesOf(varied)));
  if (const auto broken = CheckRules(*experiment, BuiltInCatalogue())) return InvalidInput(broken->message);
  const sim::TestCase empty = EmptyArena(experiment->arena);
  TRY(const auto requirements, controllers::RequirementsOf(SpecOf(*experiment, empty, experiment->seed)));
  TRY(CheckSwarmFits(*experiment, empty));
  GenomeGenerator generator(GenomeOf(*experiment), empty, requirements);
  sim::RandomStream trial = GenomeStream(search_seed_, 0);
  TRY(generator.RandomTestCase(trial));
  return Beginning{std::move(experiment), std::move(generator)};
}

void FitSearch::BeginRound() {
  std::vector<SettingsPoint> can_begin;
  const bool judged = rounds_.round() >= FitPlan::kRounds;
  std::vector<SettingsPoint> places = rounds_.Propose();
  for (SettingsPoint& place : places) {
    if (can_begin.size() == rounds_.wanted()) break;
    if (BeginningOf({.place = place, .judged = judged}).ok()) can_begin.push_back(std::move(place));
  }
  ended_ = can_begin.empty();
  if (ended_) return;
  rounds_.Begin(std::move(can_begin));
  round_ends_.push_back(rounds_.settings().size());
  AddMembers();
}

void FitSearch::AddMembers() {
  const FitPlan& plan = rounds_.plan();
  const std::size_t first = round_ends_.size() > 1 ? round_ends_[round_ends_.size() - 2] : 0;
  for (std::size_t setting = first; setting < round_ends_.back(); ++setting) {
    for (std::size_t cases = 0; cases < plan.cases.size(); ++cases) {
      const FitCases& kind = plan.cases[cases];
      const int runs = RunsOn(plan, cases, rounds_.settings()[setting].judged);
      const std::size_t different = kind.kind == FitCases::Kind::kRandom  ? static_cast<std::size_t>(runs)
                                    : kind.kind == FitCases::Kind::kEmpty ? 1
                                                                          : kind.given();
      for (std::size_t i = 0; i < different; ++i) {
        Member& member = unasked_.emplace_back();
        member.setting = setting;
        member.cases = cases;
        member.id = ++born_;
        member.given = kind.kind == FitCases::Kind::kGiven ? kind.first + i : 0;
        member.evaluations = runs / static_cast<int>(different);
      }
    }
  }
}

void FitSearch::AskFor(const Member& member, std::vector<EvaluationRequest>& requests) {
  if (!beginning_ || begun_ != member.setting) {
    beginning_.emplace(BeginningOf(rounds_.settings()[member.setting]).value());
    begun_ = member.setting;
  }
  sim::TestCase test_case = EmptyArena(beginning_->experiment->arena);
  if (member.given > 0) {
    test_case = setup_.cases[member.given - 1];
  } else if (rounds_.plan().cases[member.cases].kind == FitCases::Kind::kRandom) {
    sim::RandomStream random = GenomeStream(search_seed_, member.id);
    Result<sim::TestCase> drawn = beginning_->generator.RandomTestCase(random);
    while (!drawn) drawn = beginning_->generator.RandomTestCase(random);
    test_case = std::move(*drawn);
  }
  Individual individual = MakeIndividual(member.id, std::move(test_case));
  individual.birth_generation = static_cast<std::uint32_t>(rounds_.round());
  // A case that was handed in has no parent: what has one is a copy, or belongs to a setting alone.
  individual.parents = {member.given > 0 ? member.given : member.id};
  newborns_.push_back(individual);
  for (int evaluation = 0; evaluation < member.evaluations; ++evaluation) {
    EvaluationRequest& request = requests.emplace_back(
        Request(individual, individual.birth_generation, static_cast<std::uint32_t>(evaluation)));
    request.settings = beginning_->experiment;
    request.parents.clear();
    asked_.push_back(member);
  }
}

std::vector<EvaluationRequest> FitSearch::Ask() {
  if (AtBoundary() && !ended_) BeginRound();
  std::vector<EvaluationRequest> requests;
  while (!unasked_.empty() && asked_.size() < kLookahead) {
    AskFor(unasked_.front(), requests);
    unasked_.pop_front();
  }
  return requests;
}

void FitSearch::Told(const EvaluationOutcome& outcome) {
  const Asked asked = asked_.front();
  asked_.pop_front();
  for (const RunOutcome& run : outcome.runs) rounds_.Tell(asked.setting, asked.cases, run, reader_);
  if (AtBoundary() && rounds_.judging()) ended_ = rounds_.Chosen() != nullptr;
}

SearchProgress FitSearch::Progress() const {
  const FitPlan& plan = rounds_.plan();
  const auto each = static_cast<std::uint64_t>(plan.RunsEach());
  const auto judged = static_cast<std::uint64_t>(plan.RunsJudged());
  const std::uint64_t attempts = std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(std::ranges::count_if(rounds_.settings(), &FitSetting::judged)));
  const std::uint64_t planned = ended_ ? evaluations_done_ : plan.settings * each + attempts * judged;
  return {.generation = static_cast<std::uint32_t>(rounds_.round()),
          .generations = static_cast<std::uint32_t>(FitPlan::kRounds + attempts),
          .evaluations_done = evaluations_done_,
          .evaluations_planned = planned,
          .individuals_planned = planned,
          .finished = ended_};
}

void FitSearch::SaveRest(CanonicalEncoder& encoder) const {
  encoder.Uint(round_ends_.size());
  std::size_t setting = 0;
  for (const std::size_t end : round_ends_) {
    encoder.Uint(end - setting);
    for (; setting < end; ++setting) {
      for (const double place : rounds_.settings()[setting].place) encoder.Double(place);
    }
  }
}

Status FitSearch::RestoreRest(CanonicalDecoder& decoder, const History& history) {
  const std::size_t dimensions = rounds_.plan().varied.size();
  const std::uint64_t told = std::exchange(evaluations_done_, 0);
  std::deque<Asked> expected;
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    std::vector<SettingsPoint> places;
    for (std::uint64_t more = decoder.Uint(); more > 0 && decoder.ok(); --more) {
      SettingsPoint& place = places.emplace_back();
      for (std::size_t i = 0; i < dimensions; ++i) place.push_back(decoder.Double());
      if (std::ranges::any_of(place, [](double one) { return !(one >= 0.0 && one <= 1.0); }))
        return Damaged("a setting is out of its range");
    }
    if (places.empty() || places.size() > rounds_.plan().settings) return Damaged("a round does not fit");
    rounds_.Begin(std::move(places));
    round_ends_.push_back(rounds_.settings().size());
    AddMembers();
    for (; !unasked_.empty(); unasked_.pop_front())
      expected.insert(expected.end(), static_cast<std::size_t>(unasked_.front().evaluations),
                      unasked_.front());
  }
  TRY(history([&](const EvaluationOutcome& outcome) {
    if (expected.empty()) return;
    for (const RunOutcome& run : outcome.runs)
      rounds_.Tell(expected.front().setting, expected.front().cases, run, reader_);
    expected.pop_front();
    ++evaluations_done_;
  }));
  if (!expected.empty() || evaluations_done_ != told)
    return Damaged(
        fmt::format("it has seen {} evaluations, but the runs of {} are stored", told, evaluations_done_));
  rounds_.Summarise();
  ended_ = rounds_.judging() && rounds_.Chosen() != nullptr;
  return Ok{};
}

SearchRow FitRow() {
  return {.info = {.name = "fit",
                   .description = "settings under which runs are as they were measured: gauntlet fit",
                   .keys = {"genome.", "fit."}},
          .number = 9,
          .title = "fit of settings",
          .plan =
              [](const Experiment& e) {
                return FormatCount(static_cast<std::uint64_t>(e.fit.runs)) + " runs of different settings";
              },
          .make = Make<FitSearch>,
          .purpose = sim::SeedPurpose::kFit,
          .command = "fit",
          .varies_settings = true};
}

}  // namespace gauntlet
