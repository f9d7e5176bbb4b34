// What is stored is what is read, and nothing stored can be changed.
// Covers: master/store/line_table.cc, master/store/sqlite_tables.cc, master/store/totals_table.cc
#include "master/store/sqlite_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <limits>

#include "master/store/run_numbers.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

class SqliteStoreTest : public testing::Test {
 protected:
  void SetUp() override {
    CreateStoreWithSearch(path_);
    Reopen();
  }
  void Reopen() {
    store_.reset();
    Result<std::unique_ptr<SqliteStore>> opened = SqliteStore::Open(path_, {});
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    store_ = *std::move(opened);
  }
  void Flush() {
    const Status flushed = store_->Flush();
    ASSERT_TRUE(flushed.ok()) << flushed.error().message;
  }

  ScratchDirectory scratch_;
  std::string path_ = scratch_ / "campaign.db";
  std::unique_ptr<SqliteStore> store_;
};

TEST_F(SqliteStoreTest, MetaIsWhatTheCampaignWasMadeWith) {
  EXPECT_EQ(store_->meta(), MakeMeta());
}

TEST_F(SqliteStoreTest, LinesComeBackAndAreFoundByTheirNames) {
  store_->AddLine({1, 1, "a", "content", 1, 2});
  store_->AddLine({1, 2, "", "other", 3, 1});  // two without a name are no conflict
  store_->AddLine({1, 3, "", "other", 4, 1});
  Flush();
  Reopen();
  const std::vector<StoredLine> after = store_->LoadLines(1, 1).value();
  ASSERT_EQ(after.size(), 2U);
  EXPECT_EQ(after[0].individual, 2U);
  EXPECT_EQ(after[0].name, "");
  const std::optional<StoredLine> found = store_->FindLine(1, "a").value();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->content, "content");
  EXPECT_EQ(found->first_run, 1U);
  EXPECT_EQ(found->runs, 2U);
  EXPECT_FALSE(store_->FindLine(1, "b").value().has_value());
  store_->AddLine({1, 4, "a", "content", 5, 1});
  EXPECT_FALSE(store_->Flush().ok()) << "a name is given once";
}

TEST_F(SqliteStoreTest, ASearchKnowsItsLastRun) {
  for (RunId id = 1; id <= 3; ++id) store_->AddRun(MakeRun(id));
  Flush();
  EXPECT_EQ(store_->LoadSearches().value().at(0).last_run, 3U);
}

TEST_F(SqliteStoreTest, RunsComeBackBitByBit) {
  for (RunId id = 1; id <= 40; ++id) store_->AddRun(MakeRun(id));
  StoredRun extreme = MakeRun(41);
  extreme.id = std::numeric_limits<std::int64_t>::max();
  extreme.individual = std::numeric_limits<std::uint64_t>::max();
  extreme.evaluation = extreme.replicate = extreme.generation = std::numeric_limits<std::uint32_t>::max();
  extreme.fitness = std::numeric_limits<double>::denorm_min();
  extreme.verdict = static_cast<sim::Verdict>(std::numeric_limits<int>::min());
  extreme.spec = "";
  extreme.result = std::string("\0'\"\xff", 4);
  extreme.worker = "";
  store_->AddRun(extreme);
  Flush();
  Reopen();
  for (RunId id = 1; id <= 40; ++id) {
    Result<std::optional<StoredRun>> run = store_->LoadRun(id);
    ASSERT_TRUE(run.ok() && run->has_value());
    EXPECT_TRUE(SameRun(**run, MakeRun(id))) << id;
  }
  Result<std::optional<StoredRun>> run = store_->LoadRun(extreme.id);
  ASSERT_TRUE(run.ok() && run->has_value());
  EXPECT_TRUE(SameRun(**run, extreme));
}

TEST_F(SqliteStoreTest, ARunThatWasNeverStoredIsNoError) {
  Result<std::optional<StoredRun>> run = store_->LoadRun(7);
  ASSERT_TRUE(run.ok());
  EXPECT_FALSE(run->has_value());
}

TEST_F(SqliteStoreTest, RunsAreVisitedInIdOrderWhateverOrderTheyCameIn) {
  store_->AddSearch(MakeSearch(2));
  const RunId of_search_2 = RunIdOf(2, 7);
  for (const RunId id : {RunId{9}, RunId{2}, of_search_2, RunId{30}, RunId{1}, RunId{8}}) {
    StoredRun run = MakeRun(id);
    run.search = SearchOf(id);
    store_->AddRun(run);
  }
  Flush();
  std::vector<RunId> ids;
  const auto collect = [&ids](const StoredRun& run) {
    ids.push_back(run.id);
    return Ok{};
  };
  ASSERT_TRUE(store_->ForEachRun(1, 0, collect).ok());
  EXPECT_THAT(ids, testing::ElementsAre(1, 2, 8, 9, 30));
  ids.clear();
  ASSERT_TRUE(store_->ForEachRun(1, 2, collect).ok());
  EXPECT_THAT(ids, testing::ElementsAre(8, 9, 30));
  ids.clear();
  ASSERT_TRUE(store_->ForEachRun(2, 0, collect).ok());
  EXPECT_THAT(ids, testing::ElementsAre(of_search_2));
  ids.clear();
  ASSERT_TRUE(store_->ForEachRun(3, 0, collect).ok());
  EXPECT_THAT(ids, testing::IsEmpty());
}

TEST_F(SqliteStoreTest, AVisitThatFailsIsTheLast) {
  for (const RunId id : {RunId{1}, RunId{2}, RunId{3}}) store_->AddRun(MakeRun(id));
  Flush();
  int visits = 0;
  const Status read = store_->ForEachRun(1, 0, [&](const StoredRun& run) -> Status {
    ++visits;
    if (run.id < 2) return Ok{};
    return InvalidInput("enough");
  });
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().message, "enough");
  EXPECT_EQ(visits, 2);
}

TEST_F(SqliteStoreTest, SearchesAreFinishedByARowOfTheirOwn) {
  store_->AddSearch(MakeSearch(2));
  const RunId first_end = RunIdOf(2, 7);
  const RunId second_end = RunIdOf(2, 9);  // it was made longer
  for (const RunId end : {first_end, first_end, second_end}) store_->MarkFinished(2, end);
  Flush();
  Reopen();
  Result<std::vector<StoredSearch>> searches = store_->LoadSearches();
  ASSERT_TRUE(searches.ok());
  ASSERT_EQ(searches->size(), 2u);
  EXPECT_EQ((*searches)[0].finished_with, 0U);
  EXPECT_EQ((*searches)[1].finished_with, second_end);
  EXPECT_EQ((*searches)[1].id, 2u);
  EXPECT_EQ((*searches)[1].name, "evolve");
  EXPECT_EQ((*searches)[1].algorithm, "genetic");
  EXPECT_EQ((*searches)[1].seed, MakeSearch(2).seed);
}

TEST_F(SqliteStoreTest, IndividualsComeBackAsTheyWereBorn) {
  std::vector<Individual> born;
  for (IndividualId id = 1; id <= 30; ++id) born.push_back(MakeIndividual(id));
  store_->AddIndividuals(1, born);
  Flush();
  Reopen();
  Result<std::vector<Individual>> loaded = store_->LoadIndividuals(1);
  ASSERT_TRUE(loaded.ok());
  ASSERT_EQ(loaded->size(), born.size());
  for (std::size_t i = 0; i < born.size(); ++i) EXPECT_TRUE(SameBirth((*loaded)[i], born[i])) << i;
}

TEST_F(SqliteStoreTest, TheNewestStateIsTheOneThatSawTheLastRun) {
  store_->AddSearch(MakeSearch(2));
  for (const RunId last : {20, 60, 40}) store_->SaveState(MakeState(1, last));
  store_->SaveState(MakeState(2, 100));
  Flush();
  Reopen();
  Result<std::optional<SavedState>> state = store_->LoadNewestState(1);
  ASSERT_TRUE(state.ok() && state->has_value());
  EXPECT_EQ((*state)->last_run, 60u);
  EXPECT_EQ((*state)->generation, MakeState(1, 60).generation);
  EXPECT_EQ((*state)->state, MakeState(1, 60).state);
  EXPECT_EQ((*state)->results_digest, MakeState(1, 60).results_digest);
  Result<std::optional<SavedState>> none = store_->LoadNewestState(3);
  ASSERT_TRUE(none.ok());
  EXPECT_FALSE(none->has_value());
}

TEST_F(SqliteStoreTest, EventsKeepTheirOrder) {
  store_->AddEvent({1700000000000, "start", "2 workers"});
  store_->AddEvent({1600000000000, "worker-lost", "späte Nachricht 'x'"});
  store_->AddEvent({1700000000001, "stop", ""});
  Flush();
  Reopen();
  Result<std::vector<StoredEvent>> events = store_->LoadEvents();
  ASSERT_TRUE(events.ok());
  ASSERT_EQ(events->size(), 3u);
  EXPECT_EQ((*events)[0].kind, "start");
  EXPECT_EQ((*events)[1].unix_ms, 1600000000000);
  EXPECT_EQ((*events)[1].text, "späte Nachricht 'x'");
  EXPECT_EQ((*events)[2].text, "");
}

// A resumed master reports individuals and states again that a former one had stored.
TEST_F(SqliteStoreTest, RepeatingIndividualsAndStatesChangesNothing) {
  for (int time = 0; time < 2; ++time) {
    store_->AddIndividuals(1, {MakeIndividual(1), MakeIndividual(2)});
    store_->SaveState(MakeState(1, 20));
    Flush();
  }
  Result<std::vector<Individual>> loaded = store_->LoadIndividuals(1);
  ASSERT_TRUE(loaded.ok());
  EXPECT_EQ(loaded->size(), 2u);
}

TEST_F(SqliteStoreTest, AnotherIndividualUnderTheSameIdIsAnError) {
  store_->AddIndividuals(1, {MakeIndividual(1)});
  Individual other = MakeIndividual(1);
  other.test_case.obstacles.push_back({0.5, 0.5, 1.0, 0.2, 90.0});
  store_->AddIndividuals(1, {other});
  const Status flushed = store_->Flush();
  ASSERT_FALSE(flushed.ok());
  EXPECT_EQ(flushed.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(flushed.error().message, HasSubstr("individual 1 of search 1 is stored already"));
}

TEST_F(SqliteStoreTest, AnotherStateAfterTheSameRunIsAnError) {
  store_->SaveState(MakeState(1, 20));
  SavedState other = MakeState(1, 20);
  other.state[100] = static_cast<char>(other.state[100] ^ 1);
  store_->SaveState(other);
  const Status flushed = store_->Flush();
  ASSERT_FALSE(flushed.ok());
  EXPECT_EQ(flushed.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(flushed.error().message, HasSubstr("the state of search 1 after run 20"));
}

TEST_F(SqliteStoreTest, ARunIsNeverStoredTwice) {
  store_->AddRun(MakeRun(1));
  Flush();
  StoredRun second = MakeRun(1);
  second.hash = 42;
  store_->AddRun(second);
  const Status flushed = store_->Flush();
  ASSERT_FALSE(flushed.ok());
  EXPECT_EQ(flushed.error().kind, ErrorKind::kInternal);
  EXPECT_THAT(flushed.error().message, HasSubstr("run 1"));
  Result<std::optional<StoredRun>> stored = store_->LoadRun(1);
  ASSERT_TRUE(stored.ok() && stored->has_value());
  EXPECT_TRUE(SameRun(**stored, MakeRun(1)));
}

TEST_F(SqliteStoreTest, ARunOfAnUnknownSearchIsRefused) {
  StoredRun run = MakeRun(1);
  run.search = 99;
  store_->AddRun(run);
  const Status flushed = store_->Flush();
  ASSERT_FALSE(flushed.ok());
  EXPECT_THAT(flushed.error().message, HasSubstr("FOREIGN KEY"));
}

class InsertOnlyTest : public SqliteStoreTest, public testing::WithParamInterface<const char*> {};

TEST_P(InsertOnlyTest, RowsCanNeitherBeChangedNorDeleted) {
  store_->AddRun(MakeRun(1));
  store_->AddIndividuals(1, {MakeIndividual(1)});
  store_->SaveState(MakeState(1, 1));
  store_->MarkFinished(1, 1);
  store_->AddEvent({1, "start", ""});
  Flush();
  store_.reset();
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path_.c_str(), &db), SQLITE_OK);
  const std::string table = GetParam();
  const std::string column = table == "meta"                            ? "value"
                             : table == "searches" || table == "events" ? "id"
                             : table == "records"                       ? "run"
                             : table == "examples"                      ? "kind"
                                                                        : "search";
  for (const std::string& sql : {"UPDATE " + table + " SET " + column + " = 5", "DELETE FROM " + table}) {
    EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_CONSTRAINT) << sql;
    EXPECT_THAT(sqlite3_errmsg(db), HasSubstr("stored rows are never changed"));
  }
  sqlite3_close(db);
}

INSTANTIATE_TEST_SUITE_P(Tables, InsertOnlyTest,
                         testing::Values("meta", "searches", "finished", "individuals", "runs", "records",
                                         "examples", "states", "events"),
                         [](const testing::TestParamInfo<const char*>& table) {
                           return std::string(table.param);
                         });

TEST_F(SqliteStoreTest, AStateWhoseBitsHaveTurnedIsReported) {
  store_->SaveState(MakeState(1, 20));
  Flush();
  store_.reset();
  std::string bytes = ReadFile(path_);
  const std::size_t place = bytes.find(MakeState(1, 20).state.substr(0, 64));
  ASSERT_NE(place, std::string::npos);
  bytes[place + 10] = static_cast<char>(bytes[place + 10] ^ 0x20);
  WriteFile(path_, bytes);
  Reopen();
  Result<std::optional<SavedState>> state = store_->LoadNewestState(1);
  ASSERT_FALSE(state.ok());
  EXPECT_EQ(state.error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(state.error().message, "the state of search 1 after run 20 is damaged: its checksum differs");
}

TEST(SearchOf, IsTheSearchOfItsRunIds) {
  for (const SearchId search : {1U, 2U, 1000U}) {
    EXPECT_EQ(SearchOf(RunIdOf(search, 1)), search);
    EXPECT_EQ(SearchOf(RunIdOf(search, (1ULL << 40) - 1)), search);
  }
}

}  // namespace
}  // namespace gauntlet
