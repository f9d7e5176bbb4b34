// A disk that is full, that fails, that tears writes, and a loss of power: whatever was acknowledged is found
// again, and nothing by halves.
#include <errno.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "master/store/sqlite_store.h"
#include "tests/master/store/fault_vfs.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

constexpr RunId kRuns = 36;
constexpr int kCheckpointPages = 8;  // several checkpoints within the workload

Result<std::unique_ptr<SqliteStore>> OpenOn(const std::string& path, const std::string& vfs) {
  SqliteStore::Options options;
  options.vfs = vfs;
  options.checkpoint_pages = kCheckpointPages;
  return SqliteStore::Open(path, std::move(options));
}

struct WorkloadReport {
  std::set<RunId> acknowledged;
  std::set<RunId> states;  // last_run of the states that a successful Flush covered
  std::optional<Error> error;
};

// Runs in groups of three, and a state after each tenth run. `after_group` sees the acknowledged runs so far.
WorkloadReport Work(SqliteStore& store, RunId first,
                    const std::function<void(const WorkloadReport&)>& after_group = nullptr) {
  WorkloadReport report;
  for (RunId id = first; id <= kRuns && !report.error; ++id) {
    store.AddRun(MakeRun(id));
    if (id % 10 == 0) store.SaveState(MakeState(1, id));
    if (id % 3 != 0 && id != kRuns) continue;
    const Status flushed = store.Flush();
    if (!flushed) report.error = flushed.error();
    Result<std::vector<RunId>> committed = store.Committed();
    if (committed) report.acknowledged.insert(committed->begin(), committed->end());
    if (flushed) {
      for (RunId last = 10; last <= id; last += 10) report.states.insert(last);
    }
    if (after_group) after_group(report);
  }
  return report;
}

// Everything acknowledged is there as it was given, nothing is there that was never given, and what is
// missing can be added.
void ExpectWhole(const std::string& path, const WorkloadReport& report, const std::string& what) {
  {
    Result<std::unique_ptr<SqliteStore>> looking = SqliteStore::OpenReadOnly(path);
    ASSERT_TRUE(looking.ok()) << what << ": " << looking.error().message;
  }
  const FaultVfs vfs;
  Result<std::unique_ptr<SqliteStore>> store = OpenOn(path, vfs.name());
  ASSERT_TRUE(store.ok()) << what << ": " << store.error().message;
  std::set<RunId> found;
  for (const StoredRun& run : RunsOf(**store)) {
    EXPECT_TRUE(SameRun(run, MakeRun(run.id))) << what << ": run " << run.id;
    found.insert(run.id);
  }
  EXPECT_TRUE(
      std::includes(found.begin(), found.end(), report.acknowledged.begin(), report.acknowledged.end()))
      << what << ": an acknowledged run is missing";
  // Groups are committed in order and whole: what is found is a prefix.
  EXPECT_EQ(found.empty() ? 0 : *found.rbegin(), found.size()) << what;
  Result<std::optional<SavedState>> state = (*store)->LoadNewestState(1);
  ASSERT_TRUE(state.ok()) << what << ": " << state.error().message;
  const RunId newest = state->has_value() ? (*state)->last_run : 0;
  EXPECT_GE(newest, report.states.empty() ? 0 : *report.states.rbegin()) << what;
  EXPECT_TRUE(newest == 0 || found.contains(newest)) << what << ": a state without its results";

  const WorkloadReport rest = Work(**store, found.size() + 1);
  EXPECT_FALSE(rest.error.has_value()) << what << ": " << rest.error->message;
  EXPECT_EQ(RunsOf(**store).size(), kRuns) << what;
}

struct FaultCase {
  std::string name;
  Fault fault;
  bool lasting;
  ErrorKind kind;
};

void PrintTo(const FaultCase& fault, std::ostream* os) {
  *os << fault.name;
}

class WriteFaultTest : public testing::TestWithParam<FaultCase> {};

TEST_P(WriteFaultTest, AtAnyWriteLosesNothingAcknowledged) {
  std::int64_t writes = 0;
  {
    const ScratchDirectory scratch;
    FaultVfs vfs;
    CreateStoreWithSearch(scratch / "campaign.db");
    Result<std::unique_ptr<SqliteStore>> store = OpenOn(scratch / "campaign.db", vfs.name());
    ASSERT_TRUE(store.ok());
    const WorkloadReport undisturbed = Work(**store, 1);
    ASSERT_FALSE(undisturbed.error.has_value());
    ASSERT_EQ(undisturbed.acknowledged.size(), kRuns);
    writes = vfs.writes();
    ASSERT_GT(vfs.syncs("campaign.db"), 2) << "the workload is meant to go through checkpoints";
  }
  int stopped = 0;
  for (std::int64_t at = 0; at < writes; ++at) {
    const ScratchDirectory scratch;
    const std::string path = scratch / "campaign.db";
    CreateStoreWithSearch(path);
    WorkloadReport report;
    {
      FaultVfs vfs;
      Result<std::unique_ptr<SqliteStore>> store = OpenOn(path, vfs.name());
      ASSERT_TRUE(store.ok());
      vfs.FailWrites(GetParam().fault, at, GetParam().lasting);
      report = Work(**store, 1);
      if (report.error) {
        ++stopped;
        EXPECT_EQ(report.error->kind, GetParam().kind) << report.error->message;
        EXPECT_THAT(report.error->message, HasSubstr(path));
        if (GetParam().kind == ErrorKind::kNoSpace) {
          EXPECT_THAT(report.error->message, HasSubstr("disk is full"));
        }
      } else {
        EXPECT_EQ(report.acknowledged.size(), kRuns) << "write " << at << " failed and nobody noticed";
      }
      vfs.FailWrites(Fault::kNone, 0, false);
    }
    ExpectWhole(path, report, fmt::format("{} at write {}", GetParam().name, at));
  }
  EXPECT_GT(stopped, writes / 4);
}

INSTANTIATE_TEST_SUITE_P(
    StoreFaults, WriteFaultTest,
    testing::Values(FaultCase{"DiskFullForGood", Fault::kDiskFull, true, ErrorKind::kNoSpace},
                    FaultCase{"DiskFullOnce", Fault::kDiskFull, false, ErrorKind::kNoSpace},
                    FaultCase{"IoErrorForGood", Fault::kIoError, true, ErrorKind::kIo},
                    FaultCase{"TornWriteOnce", Fault::kTornWrite, false, ErrorKind::kIo}),
    [](const testing::TestParamInfo<FaultCase>& fault) { return fault.param.name; });

TEST(SyncFaultTest, AFailedSyncAcknowledgesNothingAndEndsTheStore) {
  for (std::int64_t at = 0; at < 25; ++at) {
    const ScratchDirectory scratch;
    const std::string path = scratch / "campaign.db";
    CreateStoreWithSearch(path);
    WorkloadReport report;
    {
      FaultVfs vfs;
      Result<std::unique_ptr<SqliteStore>> store = OpenOn(path, vfs.name());
      ASSERT_TRUE(store.ok());
      vfs.FailSyncs(at);
      report = Work(**store, 1);
      ASSERT_TRUE(report.error.has_value());
      EXPECT_EQ(report.error->kind, ErrorKind::kIo) << report.error->message;
      EXPECT_LE(report.acknowledged.size(), static_cast<std::size_t>(3 * at));
    }
    ExpectWhole(path, report, fmt::format("sync {}", at));
  }
}

TEST(PowerLossTest, LeavesWhatWasAcknowledgedAndNothingByHalves) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "campaign.db";
  CreateStoreWithSearch(path);
  const std::string first_content = ReadFile(path);
  std::vector<std::pair<std::size_t, WorkloadReport>> acknowledgements;  // from this operation on
  std::vector<FaultVfs::Operation> operations;
  {
    FaultVfs vfs;
    Result<std::unique_ptr<SqliteStore>> store = OpenOn(path, vfs.name());
    ASSERT_TRUE(store.ok());
    const WorkloadReport report = Work(**store, 1, [&](const WorkloadReport& so_far) {
      acknowledgements.emplace_back(vfs.position(), so_far);
    });
    ASSERT_FALSE(report.error.has_value());
    operations = vfs.operations();
  }
  std::mt19937 random(20181);
  for (int loss = 0; loss < 150; ++loss) {
    const std::size_t cut = random() % (operations.size() + 1);
    WorkloadReport due;
    for (const auto& [position, report] : acknowledgements) {
      if (position <= cut) due = report;
    }
    const auto survival = random() % 5;  // of four unsynchronised sectors, so many survive
    const auto survives = [&random, survival] { return random() % 4 < survival; };
    const ScratchDirectory after;
    WriteFile(after / "campaign.db", AfterPowerLoss(operations, cut, "campaign.db", first_content, survives));
    WriteFile(after / "campaign.db-wal", AfterPowerLoss(operations, cut, "campaign.db-wal", "", survives));
    ExpectWhole(after / "campaign.db", due, fmt::format("loss {} at operation {}", loss, cut));
  }
}

}  // namespace
}  // namespace gauntlet
