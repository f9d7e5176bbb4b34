#include "master/report/stored_search.h"

#include <utility>
#include <vector>

#include "master/search/case_list_search.h"
#include "master/search/make_search.h"
#include "master/store/run_numbers.h"

namespace gauntlet::master {

Result<std::unique_ptr<SearchAlgorithm>> MakeStoredSearch(const Experiment& experiment, SearchId id,
                                                          ResultStore& store) {
  if (experiment.search.kind != SearchKind::kCases) return MakeSearch(experiment, kOnlySearch);
  Result<std::vector<Individual>> individuals = store.LoadIndividuals(id);
  if (!individuals) return individuals.error();
  if (individuals->empty()) {
    return Error{ErrorKind::kCorrupt,
                 "the campaign was stopped before its cases were stored: evaluate them anew"};
  }
  std::vector<sim::TestCase> cases;
  for (Individual& individual : *individuals) cases.push_back(std::move(individual.test_case));
  return std::unique_ptr<SearchAlgorithm>(
      std::make_unique<CaseListSearch>(std::move(cases), experiment.search.replicates));
}

}  // namespace gauntlet::master
