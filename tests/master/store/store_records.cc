#include "tests/master/store/store_records.h"

#include <fmt/format.h>

#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

namespace gauntlet {
namespace {

// Bytes of every value, zero included; no two ids share them.
std::string MakeBytes(std::uint64_t id, std::size_t size) {
  std::string bytes(size, '\0');
  std::uint64_t state = id * 0x9e3779b97f4a7c15ULL + 1;
  for (char& byte : bytes) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    byte = static_cast<char>(state >> 56);
  }
  return bytes;
}

}  // namespace

StoredRun MakeRun(RunId id, std::size_t result_size) {
  const auto small = static_cast<std::uint32_t>(id);
  StoredRun run;
  run.id = id;
  run.search = 1;
  run.individual = id * 3;
  run.evaluation = small % 7;
  run.replicate = small % 5;
  run.generation = small / 20;
  run.seed = ~id;  // the top bit is set
  run.spec = MakeBytes(id, 600);
  run.spec_hash = id * 0x9e3779b97f4a7c15ULL;
  run.result = MakeBytes(~id, result_size);
  run.hash = id * 0xff51afd7ed558ccdULL;
  run.worker = fmt::format("worker-{}@host", id % 64);
  run.attempt = 1 + small % 3;
  run.verdict = static_cast<sim::Verdict>(1 + small % 6);
  run.fitness = 1.0 / static_cast<double>(id + 1);
  if (id % 8 == 1) run.fitness = -0.0;
  if (id % 8 == 3) run.fitness = std::numeric_limits<double>::quiet_NaN();
  if (id % 8 == 5) run.fitness = -std::numeric_limits<double>::infinity();
  run.total_failure = id % 2 == 0;
  run.failure_type = static_cast<int>(small % 21) - 1;
  if (!run.completed()) run.message = fmt::format("rule-{}: as it was said", id % 3);
  return run;
}

Individual MakeIndividual(IndividualId id) {
  Individual individual;
  individual.id = id;
  if (id > 2) individual.parents = {id - 2, id - 1};
  individual.birth_generation = static_cast<std::uint32_t>(id / 20);
  individual.test_case.name = fmt::format("case {}", id);
  individual.test_case.side_x = 6.5;
  for (std::uint64_t gene = 0; gene < id % 9; ++gene) {
    individual.test_case.obstacles.push_back({0.1 * static_cast<double>(id), -0.0, 1.25, 0.1, 359.0});
  }
  if (id % 2 == 0)
    individual.test_case.spawn_area = sim::Rectangle{sim::Vec2(-1.5, -2.5), sim::Vec2(0.5, 1.5)};
  if (id % 3 == 0) individual.test_case.robots = static_cast<int>(id);
  if (id % 5 == 0) individual.test_case.center = {0.25, -static_cast<double>(id)};
  return individual;
}

SavedState MakeState(SearchId search, RunId last_run) {
  SavedState state;
  state.search = search;
  state.generation = static_cast<std::uint32_t>(last_run / 20);
  state.last_run = last_run;
  state.state = MakeBytes(last_run + 1000000, 6000);
  state.results_digest = MakeBytes(last_run + 2000000, 32);
  return state;
}

bool SameRun(const StoredRun& a, const StoredRun& b) {
  return a.id == b.id && a.search == b.search && a.individual == b.individual &&
         a.evaluation == b.evaluation && a.replicate == b.replicate && a.generation == b.generation &&
         a.seed == b.seed && a.spec == b.spec && a.spec_hash == b.spec_hash && a.result == b.result &&
         a.hash == b.hash && a.worker == b.worker && a.attempt == b.attempt && a.verdict == b.verdict &&
         std::bit_cast<std::uint64_t>(a.fitness) == std::bit_cast<std::uint64_t>(b.fitness) &&
         a.total_failure == b.total_failure && a.failure_type == b.failure_type && a.message == b.message;
}

bool SameBirth(const Individual& a, const Individual& b) {
  const sim::TestCase& x = a.test_case;
  const sim::TestCase& y = b.test_case;
  if (x.spawn_area.has_value() != y.spawn_area.has_value()) return false;
  if (x.spawn_area && (x.spawn_area->min != y.spawn_area->min || x.spawn_area->max != y.spawn_area->max))
    return false;
  return a.id == b.id && a.parents == b.parents && a.birth_generation == b.birth_generation &&
         x.name == y.name && x.side_x == y.side_x && x.side_y == y.side_y &&
         x.wall_thickness == y.wall_thickness && x.obstacles == y.obstacles && x.robots == y.robots &&
         x.center == y.center;
}

ScratchDirectory::ScratchDirectory() {
  char path[] = "/tmp/gauntlet-store-XXXXXX";
  GAUNTLET_CHECK(mkdtemp(path) != nullptr, "no scratch directory");
  path_ = path;
}

ScratchDirectory::~ScratchDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string ReadFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

void WriteFile(const std::string& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << bytes;
  GAUNTLET_CHECK(out.good(), path);
}

std::string ContentOf(const std::string& directory) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with("-shm")) names.insert(name);  // memory that open connections share, not content
  }
  std::string content;
  for (const std::string& name : names) {
    content += fmt::format("{}:{}\n", name, ReadFile(directory + "/" + name));
  }
  return content;
}

void CreateStoreWithSearch(const std::string& path) {
  // Made once and copied: making one waits for the disk several times.
  static const std::string made = [] {
    const ScratchDirectory scratch;
    const Status created = CreateDatabase(scratch / "campaign.db", MakeMeta());
    GAUNTLET_CHECK(created.ok(), created.error().message);
    Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(scratch / "campaign.db", {});
    (*store)->AddSearch(MakeSearch(1));
    store->reset();
    return ReadFile(scratch / "campaign.db");
  }();
  WriteFile(path, made);
}

std::vector<StoredRun> RunsOf(ResultStore& store, SearchId search) {
  std::vector<StoredRun> runs;
  const Status read = store.ForEachRun(search, 0, [&runs](const StoredRun& run) {
    runs.push_back(run);
    return Ok{};
  });
  GAUNTLET_CHECK(read.ok(), read.error().message);
  return runs;
}

}  // namespace gauntlet
