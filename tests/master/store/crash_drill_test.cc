// A process that stores runs is killed at random moments: what it had been told to be durable is there.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <map>
#include <random>

#include "master/store/sqlite_store.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

void Acknowledge(SqliteStore& store, int out, RunId& waiting) {
  Result<std::vector<RunId>> committed = store.Committed();
  if (!committed) _exit(3);
  for (const RunId acknowledged : *committed) {
    if (write(out, &acknowledged, sizeof acknowledged) != sizeof acknowledged) _exit(4);
  }
  waiting -= committed->size();
}

// The child: stores runs from `first` on and writes the id of every acknowledged one to `out`, until it is
// killed.
[[noreturn]] void StoreForEver(const std::string& path, RunId first, int out) {
  Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(path, {});
  if (!store) _exit(2);
  RunId waiting = 0;
  for (RunId id = first;; ++id) {
    (*store)->AddRun(MakeRun(id));
    ++waiting;
    if (id % 20 == 0) {
      (*store)->AddIndividuals(1, {MakeIndividual(id), MakeIndividual(id + 1)});
      (*store)->SaveState(MakeState(1, id));
    }
    // As many as a large pool has under way; enough for a group to form.
    while (waiting >= 100) {
      pollfd news{(*store)->CommitNotifier(), POLLIN, 0};
      poll(&news, 1, -1);
      Acknowledge(**store, out, waiting);
    }
    Acknowledge(**store, out, waiting);
  }
}

// Reads acknowledgements until `enough` of them have come or the time is over; 0 = until the writer is gone.
void ReadAcknowledgements(int in, std::size_t enough, std::map<RunId, int>& acknowledged) {
  std::size_t count = 0;
  while (enough == 0 || count < enough) {
    RunId id = 0;
    const ssize_t size = read(in, &id, sizeof id);
    if (size != sizeof id) return;
    ++acknowledged[id];
    ++count;
  }
}

TEST(CrashDrill, KilledAtRandomMomentsItKeepsEveryAcknowledgedRunExactlyOnce) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "campaign.db";
  CreateStoreWithSearch(path);
  std::mt19937 random(42);
  std::map<RunId, int> acknowledged;
  RunId next = 1;
  for (int kill_number = 0; kill_number < 30; ++kill_number) {
    std::array<int, 2> pipe_ends{};
    ASSERT_EQ(pipe(pipe_ends.data()), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      close(pipe_ends[0]);
      StoreForEver(path, next, pipe_ends[1]);
    }
    close(pipe_ends[1]);
    ReadAcknowledgements(pipe_ends[0], 1 + random() % 120, acknowledged);
    // Up to 3 ms later, so that every phase of a commit is met.
    const timespec pause{0, static_cast<long>(random() % 1200000)};
    nanosleep(&pause, nullptr);
    kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child ended by itself with " << WEXITSTATUS(status);
    ReadAcknowledgements(pipe_ends[0], 0, acknowledged);
    close(pipe_ends[0]);

    // Looking changes nothing; what is seen is what a new master takes up.
    const std::string before = ContentOf(scratch.path());
    std::vector<StoredRun> seen;
    {
      Result<std::unique_ptr<SqliteStore>> looking = SqliteStore::OpenReadOnly(path);
      ASSERT_TRUE(looking.ok()) << looking.error().message;
      seen = RunsOf(**looking);
    }
    ASSERT_TRUE(ContentOf(scratch.path()) == before) << "looking changed the campaign";
    std::map<RunId, int> found;
    for (const StoredRun& run : seen) {
      ++found[run.id];
      ASSERT_TRUE(SameRun(run, MakeRun(run.id))) << "run " << run.id << " after kill " << kill_number;
    }
    for (const auto& [id, times] : acknowledged) {
      ASSERT_EQ(times, 1) << "run " << id << " was acknowledged twice";
      ASSERT_EQ(found[id], 1) << "run " << id << " was acknowledged and is lost, kill " << kill_number;
    }
    ASSERT_EQ(seen.back().id, seen.size()) << "a run is missing in between";
    Result<std::unique_ptr<SqliteStore>> looking = SqliteStore::OpenReadOnly(path);
    Result<std::optional<SavedState>> state = (*looking)->LoadNewestState(1);
    ASSERT_TRUE(state.ok()) << state.error().message;
    // The parent must hold no connection when it forks.
    next = seen.size() + 1;
  }
  EXPECT_GT(acknowledged.size(), 900u);
  Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(path, {});
  ASSERT_TRUE(store.ok()) << store.error().message;
  EXPECT_EQ(RunsOf(**store).size(), next - 1);
}

}  // namespace
}  // namespace gauntlet
