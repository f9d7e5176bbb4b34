#include "search/given/repeated_case.h"

#include <fmt/format.h>

#include <array>

#include "base/number_text.h"
#include "search/given/given_search.h"

namespace gauntlet {
namespace {

const std::vector<controllers::ParameterInfo> kConfirmationParameters = {
    {"confirmations", "", 0, 0, 100000, true, "runs of each case; 0 = until there is a verdict"}};

class EvaluatedOnce final : public LayoutQuestion {
 public:
  explicit EvaluatedOnce(const sim::Genome& obstacles) : layout_(AllOf(obstacles)) {}
  const Layout& layout() const override { return layout_; }
  int runs() const override { return told_ ? 0 : 1; }
  void Tell(const LayoutRuns& /*runs*/) override { told_ = true; }

 private:
  const Layout layout_;
  bool told_ = false;
};

std::unique_ptr<LayoutQuestion> AskOnce(const Experiment& /*experiment*/, const sim::Genome& obstacles) {
  return std::make_unique<EvaluatedOnce>(obstacles);
}

std::unique_ptr<LayoutQuestion> AskForVerdict(const Experiment& experiment, const sim::Genome& obstacles) {
  return std::make_unique<RepeatedCase>(obstacles, ConfirmationReplicates(experiment));
}

std::string EvaluationPlan(const Experiment& experiment) {
  return Counted(static_cast<std::uint64_t>(experiment.search.replicates), "run") + " each";
}

std::string ConfirmationPlan(const Experiment& experiment) {
  const int replicates = ConfirmationReplicates(experiment);
  return replicates > 0 ? fmt::format("{} runs each", replicates) : "5 to 10 runs each";
}

}  // namespace

SearchRow CaseListRow() {
  return {.info = {.name = "cases",
                   .description = "given test cases from files: gauntlet evaluate",
                   .keys = {"search.replicates"}},
          .number = 2,
          .title = "given cases",
          .plan = EvaluationPlan,
          .make = Make<GivenSearch>,
          .purpose = sim::SeedPurpose::kEvaluate,
          .question = AskOnce,
          .command = "evaluate",
          .seeds_of_cases = true};
}

SearchRow ResimulationRow() {
  SearchRow row = CaseListRow();
  row.info.name = "resimulation";
  row.info.description = "members of an evolution's population once more: gauntlet evaluate --from";
  row.number = 3;
  row.title = "a population simulated again";
  row.individuals = Individuals::kPopulation;
  row.purpose = sim::SeedPurpose::kFinalResimulation;
  row.seeds_of_cases = false;
  return row;
}

int ConfirmationReplicates(const Experiment& experiment) {
  return static_cast<int>(ValueOf(kConfirmationParameters[0], experiment.search.parameters));
}

Experiment ConfirmationOf(const Experiment& experiment, int replicates) {
  Experiment confirmation = AboutCasesOf(experiment, "confirmation");
  confirmation.search.cells = experiment.search.cells;
  confirmation.search.parameters[std::string(kConfirmationParameters[0].name)] = replicates;
  return confirmation;
}

SearchRow ConfirmationRow() {
  return {.info = {.name = "confirmation",
                   .description = "how often given cases fail with fresh seeds: gauntlet confirm",
                   .keys = {"search.cells"},
                   .parameters = kConfirmationParameters},
          .number = 4,
          .title = "confirmation of cases",
          .plan = ConfirmationPlan,
          .make = Make<GivenSearch>,
          .purpose = sim::SeedPurpose::kConfirm,
          .question = AskForVerdict,
          .reads_trajectories = true,
          .command = "confirm",
          .seeds_of_cases = true};
}

Experiment CheckOf(const Experiment& experiment) {
  return AboutCasesOf(experiment, "check");
}

SearchRow CheckRow() {
  return {
      .info = {.name = "check", .description = "whether the cases of a corpus still fail: gauntlet check"},
      .number = 7,
      .title = "check of a corpus",
      .plan = ConfirmationPlan,
      .make = Make<GivenSearch>,
      .purpose = sim::SeedPurpose::kCheck,
      .question = AskForVerdict,
      .command = "check",
      .seeds_of_cases = true};
}

}  // namespace gauntlet
