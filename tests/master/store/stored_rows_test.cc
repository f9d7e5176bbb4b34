// Rows that were lost or changed behind the store's back: whoever relies on them is told.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <string>

#include "master/store/sqlite_store.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

class StoredRowsTest : public testing::Test {
 protected:
  void SetUp() override {
    CreateStoreWithSearch(path_);
    Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(path_, {});
    ASSERT_TRUE(store.ok()) << store.error().message;
    (*store)->AddSearch(MakeSearch(2));
    for (RunId id = 1; id <= 50; ++id) (*store)->AddRun(MakeRun(id));
    (*store)->AddIndividuals(1, {MakeIndividual(1), MakeIndividual(2)});
    (*store)->AddIndividuals(1, {MakeIndividual(2), MakeIndividual(3)});  // told twice
    for (int time = 0; time < 2; ++time) (*store)->SaveState(MakeState(1, 20));
    for (int time = 0; time < 2; ++time) (*store)->MarkFinished(1, 50);
    (*store)->AddEvent({1, "start", ""});
    ASSERT_TRUE((*store)->Flush().ok());
  }
  // Runs statements after dropping the triggers that guard the rows.
  void Alter(const std::string& sql) const {
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open(path_.c_str(), &db), SQLITE_OK);
    std::string drops;
    const auto take = [](void* into, int, char** row, char**) {
      *static_cast<std::string*>(into) += row[0];
      return 0;
    };
    sqlite3_exec(db, "SELECT 'DROP TRIGGER ' || name || ';' FROM sqlite_master WHERE type = 'trigger'", take,
                 &drops, nullptr);
    ASSERT_EQ(sqlite3_exec(db, (drops + sql).c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(db);
    sqlite3_close(db);
  }
  void ExpectRefusal(Checked what, const std::string& said) const {
    const Result<std::unique_ptr<SqliteStore>> store = SqliteStore::OpenReadOnly(path_, what);
    ASSERT_FALSE(store.ok()) << said;
    EXPECT_EQ(store.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(store.error().message, HasSubstr(said));
  }

  ScratchDirectory scratch_;
  std::string path_ = scratch_ / "campaign.db";
};

TEST_F(StoredRowsTest, TotalsAreThoseOfWhatIsStored) {
  const Result<std::unique_ptr<SqliteStore>> store = SqliteStore::OpenReadOnly(path_, Checked::kTotals);
  ASSERT_TRUE(store.ok()) << store.error().message;
  const Result<std::vector<SearchTotals>> totals = (*store)->LoadTotals();
  ASSERT_TRUE(totals.ok());
  ASSERT_EQ(totals->size(), 2U);
  std::uint64_t failed = 0;
  for (RunId id = 1; id <= 50; ++id) failed += MakeRun(id).completed() ? 0 : 1;
  const SearchTotals& first = totals->front();
  EXPECT_EQ(first.search, 1U);
  EXPECT_EQ(first.runs, 50U);
  EXPECT_EQ(first.runs_failed, failed);
  EXPECT_EQ(first.total_failures, 25U);
  EXPECT_EQ(first.individuals, 3U);
  EXPECT_EQ(first.finished, 1U);
  EXPECT_EQ(totals->back().runs, 0U);
  EXPECT_EQ(totals->back().finished, 0U);
}

TEST_F(StoredRowsTest, WithoutRecordsRunsAreTheSame) {
  const Result<std::unique_ptr<SqliteStore>> store = SqliteStore::OpenReadOnly(path_, Checked::kRows);
  ASSERT_TRUE(store.ok()) << store.error().message;
  RunId next = 1;
  const Status read = (*store)->ForEachRow(1, 0, [&](const StoredRun& run) {
    StoredRun expected = MakeRun(next++);
    expected.spec.clear();
    expected.result.clear();
    EXPECT_TRUE(SameRun(run, expected)) << run.id;
    return Ok{};
  });
  EXPECT_TRUE(read.ok());
  EXPECT_EQ(next, 51U);
}

struct LostTable {
  const char* name;
  Checked missed_by;  // the least of Checked that misses its rows
};

void PrintTo(const LostTable& table, std::ostream* os) {
  *os << table.name;
}

class LostTableTest : public StoredRowsTest, public testing::WithParamInterface<LostTable> {};

// What is left of a table whose page was replaced by an empty one.
TEST_P(LostTableTest, IsMissed) {
  Alter(fmt::format("DELETE FROM {}", GetParam().name));
  for (const Checked what : {Checked::kTotals, Checked::kRows, Checked::kEverything}) {
    if (what >= GetParam().missed_by)
      ExpectRefusal(what, fmt::format("the table {} holds 0 rows", GetParam().name));
  }
  const Result<std::unique_ptr<SqliteStore>> for_writing = SqliteStore::Open(path_, {});
  ASSERT_FALSE(for_writing.ok());
  EXPECT_THAT(for_writing.error().message, HasSubstr(path_ + " was changed or is damaged: the table "));
}

INSTANTIATE_TEST_SUITE_P(
    Tables, LostTableTest,
    testing::Values(LostTable{"searches", Checked::kTotals}, LostTable{"finished", Checked::kTotals},
                    LostTable{"individuals", Checked::kRows}, LostTable{"runs", Checked::kRows},
                    LostTable{"states", Checked::kRows}, LostTable{"events", Checked::kRows},
                    LostTable{"records", Checked::kEverything}),
    [](const testing::TestParamInfo<LostTable>& table) { return std::string(table.param.name); });

TEST_F(StoredRowsTest, ALostExampleIsMissed) {
  Alter("DELETE FROM examples WHERE kind = 'spec'");
  ExpectRefusal(Checked::kRows, "the table examples holds");
}

TEST_F(StoredRowsTest, ChangedTotalsAndExamplesAreNamed) {
  Alter("UPDATE totals SET runs_failed = runs_failed + 1 WHERE search = 1");
  ExpectRefusal(Checked::kTotals, "the totals of search 1 were changed: their checksum differs");
  Alter(
      "UPDATE totals SET runs_failed = runs_failed - 1 WHERE search = 1; UPDATE examples SET bytes = x'00'");
  ExpectRefusal(Checked::kTotals, "was changed: its checksum differs");
}

TEST_F(StoredRowsTest, AnIndexWithoutItsRowsIsFound) {
  Alter(
      "PRAGMA writable_schema = ON; UPDATE sqlite_master SET rootpage = (SELECT rootpage FROM sqlite_master "
      "WHERE name = 'sqlite_autoindex_meta_1') WHERE name = 'sqlite_autoindex_states_1'");
  ExpectRefusal(Checked::kRows, "damaged");
}

TEST_F(StoredRowsTest, EveryColumnOfARunIsGuarded) {
  for (const char* change :
       {"individual = 99", "evaluation = 99", "replicate = 99", "generation = 99", "seed = 99",
        "verdict = 99", "fitness_bits = 99", "total_failure = 99", "failure_type = 99", "message = 'x'",
        "hash = 99", "spec_hash = 99", "worker = 'x'", "attempt = 99", "record_hash = 99", "checksum = 99"}) {
    CreateStoreWithSearch(path_);
    SetUp();
    Alter(fmt::format("UPDATE runs SET {} WHERE id = 7", change));
    const Result<std::unique_ptr<SqliteStore>> store = SqliteStore::OpenReadOnly(path_, Checked::kRows);
    ASSERT_TRUE(store.ok()) << store.error().message;
    const Status read = (*store)->ForEachRow(1, 0, [](const StoredRun&) { return Ok{}; });
    ASSERT_FALSE(read.ok()) << change;
    EXPECT_EQ(read.error().message,
              "the campaign's database was changed or is damaged: the row of run 7 was changed: its checksum "
              "differs")
        << change;
    EXPECT_FALSE((*store)->LoadRun(7).ok()) << change;
    EXPECT_TRUE((*store)->LoadRun(8).ok()) << change;
  }
}

}  // namespace
}  // namespace gauntlet
