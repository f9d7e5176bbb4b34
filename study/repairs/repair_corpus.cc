#include "study/repairs/repair_corpus.h"

#include <filesystem>

#include <fmt/format.h>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "base/system/atomic_file.h"
#include "search/cases/corpus_file.h"
#include "study/questions/corpus_experiment.h"

namespace gauntlet {
namespace {

CorpusCase KeptCase(const Repair& repair, const Experiment& repaired, std::size_t number,
                    const std::string& dir) {
  const RepairTally tally = repair.course().TallyOf(*repair.course().repaired(), number);
  const int with_result = tally.runs - tally.without_result;
  const int failures = tally.failures - tally.without_result;
  CorpusCase kept;
  kept.name = fmt::format("case-{}", number + 1);
  kept.expected = failures == 0 ? "pass" : 2 * failures >= with_result ? "fail" : "flaky";
  kept.found_in = fmt::format("{}, with the parameters that {} has repaired", repair.cases[number].name, dir);
  const analysis::Interval interval = analysis::WilsonInterval(
      static_cast<std::uint32_t>(failures), static_cast<std::uint32_t>(with_result), analysis::kConfidence);
  kept.found = {failures, with_result, {interval.low, interval.high}};
  kept.settings = SettingsOf(repaired);
  kept.document.test_case = repair.cases[number];
  return kept;
}

}  // namespace

Status WriteRepairedCorpus(const Repair& repair, const std::string& dir, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{} cannot be made: {}", folder, error.message())};
  const Experiment repaired = RepairedExperiment(repair);
  const RepairCases& cases = repair.plan().cases;
  for (std::size_t number = 0; number < cases.first_random(); ++number) {
    if (number >= cases.training && number < cases.first_held_out()) continue;  // guards
    const CorpusCase kept = KeptCase(repair, repaired, number, dir);
    const std::string file = fmt::format("{}/{}.json", folder, kept.name);
    if (std::filesystem::exists(file, error)) continue;
    TRY(WriteFileAtomically(file, WriteCorpusCase(kept), kReadableByAll));
  }
  return Ok{};
}

}  // namespace gauntlet
