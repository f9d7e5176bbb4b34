// Records for the store's tests: made from their id alone, so that a test knows what must be read back.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "master/store/sqlite_store.h"

namespace gauntlet {

// Every field differs from run to run; every eighth fitness is special (NaN, -0.0, infinity).
StoredRun MakeRun(RunId id, std::size_t result_size = 900);
Individual MakeIndividual(IndividualId id);
SavedState MakeState(SearchId search, RunId last_run);
inline StoredSearch MakeSearch(SearchId id) {
  return {id, "evolve", "genetic", 0xfedcba9876543210ULL + id, false};
}
inline CampaignMeta MakeMeta() {
  return {"00112233445566778899aabbccddeeff", "0.1.0", "cafe", 1700000000123};
}

// Bit by bit, fitness included.
bool SameRun(const StoredRun& a, const StoredRun& b);
bool SameBirth(const Individual& a, const Individual& b);

// A directory of its own that is deleted with the object.
class ScratchDirectory {
 public:
  ScratchDirectory();
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  ~ScratchDirectory();
  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

std::string ReadFile(const std::string& path);
void WriteFile(const std::string& path, const std::string& bytes);
// Name and content of every file, one after the other: equal when nothing was changed.
std::string ContentOf(const std::string& directory);

// A new database with search 1, durable and closed.
void CreateStoreWithSearch(const std::string& path);
std::vector<StoredRun> RunsOf(ResultStore& store, SearchId search = 1);

}  // namespace gauntlet
