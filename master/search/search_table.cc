#include "master/search/search_table.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/check.h"
#include "controllers/registry.h"
#include "master/search/case_list_search.h"
#include "master/search/genetic_algorithm.h"
#include "master/search/random_search.h"
#include "master/search/steady_state_search.h"

namespace gauntlet::master {

std::span<const SearchRow> Searches() {
  static const std::array rows = {GeneticRow(), SteadyStateRow(), RandomRow(), CaseListRow()};
  return rows;
}

const SearchRow* FindSearch(std::string_view name) {
  const auto row = std::ranges::find(Searches(), name, [](const SearchRow& one) { return one.info.name; });
  return row == Searches().end() ? nullptr : &*row;
}

const SearchRow& RowOf(const Experiment& experiment) {
  const SearchRow* row = FindSearch(experiment.search.algorithm);
  GAUNTLET_CHECK(row != nullptr, experiment.search.algorithm);
  return *row;
}

const Catalogue& BuiltInCatalogue() {
  static const std::vector<SearchInfo> searches = [] {
    std::vector<SearchInfo> infos;
    for (const SearchRow& row : Searches()) infos.push_back(row.info);
    return infos;
  }();
  static const Catalogue catalogue{controllers::Scenarios(), controllers::Controllers(), searches};
  return catalogue;
}

}  // namespace gauntlet::master
