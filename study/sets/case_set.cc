#include "study/sets/case_set.h"

#include <filesystem>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace gauntlet {

Result<std::vector<CaseSet>> CasesOf(const std::vector<SearchPlan>& plans, ResultStore& store,
                                     const std::string& place, const Subset& subset) {
  std::vector<CaseSet> sets;
  const auto add = [&](const SubsetSearch& search) -> Status {
    TRY(const auto runs, SelectRuns(search, store, subset, "fitness"));
    std::set<IndividualId> wanted;
    for (const SelectedRun& run : runs) wanted.insert(run.individual);
    TRY(auto individuals, store.LoadIndividuals(search.plan.id));
    CaseSet& set = sets.emplace_back(CaseSet{search.place, search.plan.experiment, {}, {}});
    for (Individual& one : individuals) {
      if (wanted.contains(one.id)) set.members.push_back(std::move(one));
    }
    if (!search.finished) {
      set.notes.push_back(
          fmt::format("{} is half-finished: the cases of {} individuals that it has stored so far are taken",
                      search.place, set.members.size()));
    }
    return Ok{};
  };
  TRY(ForEachSearch(plans, store, place, subset, add));
  return sets;
}

Result<std::vector<CaseSet>> ReadCaseSets(const std::string& text) {
  TRY(const auto parts, SplitSet(text));
  std::vector<CaseSet> all;
  for (const SetPart& part : parts) {
    if (std::error_code error; !std::filesystem::is_directory(part.path, error)) {
      return InvalidInput(
          fmt::format("{}: cases come from a campaign's directory, not from a file", part.path));
    }
    TRY(const auto opened, OpenSubset(part));
    TRY(CheckOneSetting(opened.plans, part.path, opened.campaign.store.get()));
    TRY(auto sets, CasesOf(opened.plans, *opened.campaign.store, part.path, opened.subset));
    if (!opened.note.empty()) sets.front().notes.push_back(opened.note);
    std::ranges::move(sets, std::back_inserter(all));
  }
  return all;
}

}  // namespace gauntlet
