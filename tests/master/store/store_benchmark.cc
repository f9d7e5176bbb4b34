// How fast results become durable, and how long opening takes. Files are made below the working directory, so
// that it says which disk is measured.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>

#include "master/store/sqlite_store.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

std::string MakeFile() {
  const std::string directory = "store-benchmark." + std::to_string(getpid());
  std::filesystem::remove_all(directory);
  std::filesystem::create_directory(directory);
  CreateStoreWithSearch(directory + "/campaign.db");
  return directory;
}

void AddRuns(SqliteStore& store, RunId runs) {
  for (RunId id = 1; id <= runs; ++id) store.AddRun(MakeRun(id));
  const Status flushed = store.Flush();
  GAUNTLET_CHECK(flushed.ok(), flushed.error().message);
}

// Runs of 1.5 kB (600 B spec, 900 B result), the last one durable at the end.
void BM_StoreRuns(benchmark::State& state) {
  const auto runs = static_cast<RunId>(state.range(0));
  std::vector<StoredRun> made;
  for (RunId id = 1; id <= runs; ++id) made.push_back(MakeRun(id));
  for (auto _ : state) {
    state.PauseTiming();
    const std::string directory = MakeFile();
    Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(directory + "/campaign.db", {});
    const double cpu = CpuSeconds();
    state.ResumeTiming();
    for (const StoredRun& run : made) (*store)->AddRun(run);
    const Status flushed = (*store)->Flush();
    GAUNTLET_CHECK(flushed.ok(), flushed.error().message);
    state.PauseTiming();
    state.counters["cpu_us_per_run"] = (CpuSeconds() - cpu) * 1e6 / static_cast<double>(runs);
    state.counters["commits"] = static_cast<double>((*store)->Commits());
    store->reset();
    state.counters["bytes_per_run"] =
        static_cast<double>(std::filesystem::file_size(directory + "/campaign.db")) /
        static_cast<double>(runs);
    std::filesystem::remove_all(directory);
    state.ResumeTiming();
  }
  state.counters["runs/s"] = benchmark::Counter(
      static_cast<double>(runs) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(BM_StoreRuns)->Arg(50000)->UseRealTime()->Unit(benchmark::kMillisecond);

// One run at a time, each waited for: the latency of a commit.
void BM_CommitOneRun(benchmark::State& state) {
  const std::string directory = MakeFile();
  Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(directory + "/campaign.db", {});
  RunId id = 0;
  for (auto _ : state) {
    (*store)->AddRun(MakeRun(++id));
    const Status flushed = (*store)->Flush();
    GAUNTLET_CHECK(flushed.ok(), flushed.error().message);
  }
  store->reset();
  std::filesystem::remove_all(directory);
}
BENCHMARK(BM_CommitOneRun)->UseRealTime()->Unit(benchmark::kMicrosecond);

// Opening for reading checks every page.
void BM_OpenReadOnly(benchmark::State& state) {
  const std::string directory = MakeFile();
  {
    Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(directory + "/campaign.db", {});
    AddRuns(**store, static_cast<RunId>(state.range(0)));
  }
  for (auto _ : state) {
    Result<std::unique_ptr<SqliteStore>> store = SqliteStore::OpenReadOnly(directory + "/campaign.db");
    benchmark::DoNotOptimize(store);
  }
  std::filesystem::remove_all(directory);
}
BENCHMARK(BM_OpenReadOnly)->Arg(1000)->Arg(100000)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gauntlet
