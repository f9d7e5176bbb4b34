// The state hash: one number by which two campaigns are told to be the same, whatever the worker count, the
// order of arrival and the accidents on the way. Its encoding is fixed in master/store/README.md.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "base/result.h"
#include "master/store/result_store.h"

namespace gauntlet {

// Digest of the results that a search has been told, in logical order: a chain, so that it is resumed from 32
// bytes. Worker, attempt, time and cost have no influence.
class ResultsDigest {
 public:
  ResultsDigest() = default;  // of no results
  // kCorrupt when `bytes` are not 32.
  static Result<ResultsDigest> Restore(std::string_view bytes);

  // The next result, as if its search were the campaign's only one. Its spec and result may be empty: the
  // digest reads their numbers and the result's hash.
  void Add(const StoredRun& run);
  std::string bytes() const;

 private:
  std::array<unsigned char, 32> digest_{};
};

// 64 hex digits. `experiment`: the fields of the experiment that determine its outcome, in any fixed
// encoding; `population`: of the last complete generation; `search_state`: SearchAlgorithm::Save.
std::string StateHash(std::string_view experiment, const ResultsDigest& results, std::string_view population,
                      std::string_view search_state);

}  // namespace gauntlet
