// What a master publishes for readers elsewhere, and when it does not.
#include "master/session/snapshot_publisher.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>

#include "tests/master/store/store_records.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using testing_support::Eventually;
using testing_support::kPatience;

TEST(SnapshotPublisherTest, PublishesWhatIsNewAndNothingElse) {
  const ScratchDirectory scratch;
  const std::string database = scratch / "campaign.db";
  const std::string snapshot = scratch / "snapshot.db";
  CreateStoreWithSearch(database);
  const Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(database, {});
  ASSERT_TRUE(store.ok());
  std::atomic<int> looks = 0;
  const auto runs = [&]() -> std::size_t {
    const Result<std::unique_ptr<SqliteStore>> copy = SqliteStore::OpenReadOnly(snapshot);
    return copy.ok() ? RunsOf(**copy).size() : 0;
  };
  {
    const SnapshotPublisher publisher({.database = database,
                                       .snapshot = snapshot,
                                       .commits =
                                           [&] {
                                             ++looks;
                                             return (*store)->Commits();
                                           },
                                       .first_after = milliseconds(1),
                                       .at_least_every = milliseconds(1),
                                       .pause_per_copy = 0});
    ASSERT_TRUE(Eventually([&] { return looks > 3; }, kPatience));
    EXPECT_FALSE(std::filesystem::exists(snapshot)) << "nothing had been committed";
    for (RunId id = 1; id <= 10; ++id) (*store)->AddRun(MakeRun(id));
    ASSERT_TRUE((*store)->Flush().ok());
    EXPECT_TRUE(Eventually([&] { return runs() == 10; }, kPatience));
    (*store)->AddRun(MakeRun(11));
    ASSERT_TRUE((*store)->Flush().ok());
    EXPECT_TRUE(Eventually([&] { return runs() == 11; }, kPatience));
  }
  EXPECT_FALSE(std::filesystem::exists(snapshot + ".new"));
}

TEST(SnapshotPublisherTest, EndsAtOnceWhateverItIsWaitingFor) {
  const auto begin = std::chrono::steady_clock::now();
  {
    const SnapshotPublisher publisher({.database = "/none",
                                       .snapshot = "/none",
                                       .commits = [] { return 1U; },
                                       .first_after = std::chrono::minutes(1)});
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30)) << "it waits for a minute";
}

}  // namespace
}  // namespace gauntlet
