#include "search/repair/repair_search.h"

#include <fmt/format.h>

#include "base/number_text.h"
#include "search/failure_tally.h"
#include "search/search_table.h"

namespace gauntlet {

Result<std::unique_ptr<RepairSearch>> RepairSearch::Create(const SearchSetup& setup) {
  TRY(RepairPlan plan,
      MakeRepairPlan(setup.experiment, AllKeysOf(setup.experiment), setup.cases.size(), SearchSeed(setup)));
  return std::unique_ptr<RepairSearch>(
      new RepairSearch(setup, std::make_unique<RepairCourse>(std::move(plan), FailingOf(setup.experiment))));
}

SearchRow RepairRow() {
  return {
      .info = {.name = "repair",
               .description = "parameters with which a controller fails less in given cases: gauntlet repair",
               .keys = {"repair."}},
      .number = 11,
      .title = "repair of a controller",
      .plan =
          [](const Experiment& e) {
            return fmt::format("{} runs of different settings, then explanation and proof",
                               FormatCount(static_cast<std::uint64_t>(e.repair.runs)));
          },
      .make = Make<RepairSearch>,
      .purpose = sim::SeedPurpose::kRepair,
      .command = "repair",
      .seeds_of_cases = true,
      .varies_settings = true,
      .counts_contacts = true};
}

}  // namespace gauntlet
