// The case files that `gauntlet minimise` keeps: what is left of the cases that it has made smaller.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "master/store/result_store.h"
#include "proto/case_json.h"

namespace gauntlet {

// The folder of a campaign in which its calls stand.
inline constexpr const char* kMinimiseFolder = "/minimise";

// A case's name as files are called: "run-17", and a file's name without its ending.
std::string FileNameOf(const std::string& case_name);
// Where the call in `directory` keeps what is left of this case: the file without its ending, which is .json
// for the case and .svg for its pictures.
std::string SmallestLayoutFile(const std::string& directory, const std::string& case_name);

struct SmallestLayout {
  RunId run = 0;                 // whose case it is what is left of
  std::string file;              // with its ending
  proto::CaseDocument document;  // always with its lineage

  bool Smaller() const {
    return document.test_case.obstacles.size() < document.lineage->parent.obstacles.size();
  }
};
// What is left of the cases of runs of the campaign in `dir`, in the order of the runs; of a case that was
// minimised more than once what has the fewest obstacles. Error: a file does not read, which it names.
Result<std::vector<SmallestLayout>> ReadSmallestLayouts(const std::string& dir);
// The `most` with the fewest obstacles, of equally small ones first that which fails most.
std::vector<const SmallestLayout*> SmallestFirst(const std::vector<SmallestLayout>& layouts,
                                                 std::size_t most);

}  // namespace gauntlet
