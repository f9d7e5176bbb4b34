// Real workers against a fake master: results, broken runs, signals, a master that moves, nobody left behind.
// Covers: worker/runner/fork_server.cc, worker/runner/runner_pool.cc, worker/supervisor.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <set>

#include "proto/run.pb.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"
#include "tests/worker/fake_master.h"
#include "tests/worker/faulty_runs.h"
#include "worker/runner/runner.h"

namespace gauntlet::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::ElementsAre;
using testing::HasSubstr;
using testing_support::Alive;
using testing_support::ChildrenOf;
using testing_support::DescendantsOf;
using testing_support::Eventually;
using testing_support::Process;
using testing_support::ProcessResult;

constexpr milliseconds kDeadline{60'000};
constexpr const char* kFaultyWorker = GAUNTLET_BINARY_DIR "/gauntlet-worker-faulty";
constexpr std::uint64_t kMemoryLimit = 512ULL << 20;

class WorkerProcessTest : public testing::Test {
 protected:
  std::unique_ptr<Process> StartWorker(int slots = 1, const std::string& orphan_timeout = "600") {
    return std::make_unique<Process>(
        std::vector<std::string>{kFaultyWorker, access_path_, std::to_string(slots), orphan_timeout});
  }
  // Leases a run that waits for `file`, and waits until it runs.
  void LeaseAndBegin(FakeMaster& master, const std::string& peer, std::uint64_t fence,
                     const std::string& file) {
    master.Lease(peer, fence, kWaitForFile, file);
    const auto end = steady_clock::now() + kDeadline;
    while (!std::ifstream(file + kBegun).good() && steady_clock::now() < end)
      master.Await(v1::Envelope::kHeartbeat);
    ASSERT_TRUE(std::ifstream(file + kBegun).good());
  }
  // worker -> fork server -> runners
  static std::vector<pid_t> RunnersOf(const Process& worker) {
    const auto servers = ChildrenOf(worker.pid());
    return servers.size() == 1 ? ChildrenOf(servers[0]) : std::vector<pid_t>();
  }
  static testing::AssertionResult AllGone(const std::vector<pid_t>& pids) {
    const bool gone = Eventually(
        [&] { return std::none_of(pids.begin(), pids.end(), [](pid_t pid) { return Alive(pid); }); },
        kDeadline);
    return gone ? testing::AssertionSuccess() : testing::AssertionFailure() << "a process is left behind";
  }

  testing_support::TemporaryDirectory directory_;
  std::string access_path_ = directory_ / "access.json";
};

TEST_F(WorkerProcessTest, LeaseGivesItsResult) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  master.Lease(peer, 5, kComplete);
  const auto answer = master.AwaitResult(peer, 5);
  ASSERT_TRUE(answer.has_value()) << worker->Err();
  EXPECT_EQ(answer->run_id(), 1005u);
  EXPECT_FALSE(answer->has_failure());
  v1::RunResult result;
  ASSERT_TRUE(result.ParseFromString(answer->result()));
  EXPECT_EQ(result.verdict(), v1::VERDICT_COMPLETED);
  EXPECT_EQ(result.fitness(), 0.5);
  EXPECT_GT(answer->cpu_seconds(), 0.0);
  EXPECT_EQ(result.cpu_seconds(), answer->cpu_seconds());
}

TEST_F(WorkerProcessTest, HelloSaysWhoItIs) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker(3);
  const auto hello = master.Await(v1::Envelope::kHello);
  ASSERT_TRUE(hello.has_value());
  EXPECT_EQ(hello->envelope.hello().protocol_version(), 1u);
  EXPECT_EQ(hello->envelope.hello().campaign_id(), "c0ffee");
  EXPECT_NE(hello->envelope.hello().instance_id(), 0u);
  EXPECT_EQ(hello->envelope.hello().golden_hashes(0).hash(), 42u);
  EXPECT_EQ(hello->envelope.hello().slots(), 3u);
  EXPECT_EQ(hello->envelope.hello().pid(), worker->pid());
}

struct BrokenRun {
  const char* name;
  std::uint64_t what;
  v1::RunnerFailure::Kind kind;
  int signal;  // 0: not checked
  int exit_code;
  const char* tail;
};

void PrintTo(const BrokenRun& param, std::ostream* out) {
  *out << param.name;
}

class BrokenRunTest : public WorkerProcessTest, public testing::WithParamInterface<BrokenRun> {};

TEST_P(BrokenRunTest, CostsItselfAloneAndIsReportedAsWhatItIs) {
  const BrokenRun& broken = GetParam();
  if (broken.kind == v1::RunnerFailure::KIND_OUT_OF_MEMORY && !kMemoryLimitWorks) {
    GTEST_SKIP() << "no memory limit under sanitizers";
  }
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne(1.0, kMemoryLimit);
  master.Lease(peer, 5, broken.what);
  master.Lease(peer, 6, kComplete);
  const auto failed = master.AwaitResult(peer, 5);
  ASSERT_TRUE(failed.has_value()) << worker->Err();
  EXPECT_EQ(failed->failure().kind(), broken.kind) << failed->ShortDebugString();
  // A machine so crowded that it gives a run a second of CPU time in twenty ends it by the clock.
  const bool by_the_clock = failed->failure().stderr_tail().starts_with("no end after");
  if (broken.signal != 0 && kMemoryLimitWorks && !by_the_clock) {
    EXPECT_EQ(failed->failure().signal(), broken.signal);
  }
  if (broken.exit_code != 0) {
    EXPECT_EQ(failed->failure().exit_code(), broken.exit_code);
  }
  if (!by_the_clock) {
    EXPECT_THAT(failed->failure().stderr_tail(), HasSubstr(broken.tail));
  }
  EXPECT_TRUE(failed->result().empty());

  const auto next = master.AwaitResult(peer, 6);
  ASSERT_TRUE(next.has_value()) << worker->Err();
  EXPECT_FALSE(next->has_failure());
}

INSTANTIATE_TEST_SUITE_P(
    Worker, BrokenRunTest,
    testing::Values(
        BrokenRun{"Abort", kAbort, v1::RunnerFailure::KIND_CRASHED, SIGABRT, 0, "about to abort"},
        BrokenRun{"SegmentationFault", kSegmentationFault, v1::RunnerFailure::KIND_CRASHED, SIGSEGV, 0, ""},
        BrokenRun{"Exception", kThrow, v1::RunnerFailure::KIND_CRASHED, 0, kExitException,
                  "thrown on purpose"},
        BrokenRun{"Exit", kExitWithThree, v1::RunnerFailure::KIND_CRASHED, 0, 3, ""},
        BrokenRun{"EndlessLoop", kSpin, v1::RunnerFailure::KIND_HUNG, SIGXCPU, 0, ""},
        BrokenRun{"EndlessOutput", kPrintForEver, v1::RunnerFailure::KIND_HUNG, SIGXCPU, 0, "noise\n"},
        BrokenRun{"MemoryGrowth", kAllocate, v1::RunnerFailure::KIND_OUT_OF_MEMORY, 0, kExitOutOfMemory,
                  "out of memory"},
        BrokenRun{"HugeAllocation", kAllocateHuge, v1::RunnerFailure::KIND_OUT_OF_MEMORY, 0, kExitOutOfMemory,
                  ""},
        BrokenRun{"GarbageOnThePipe", kWriteGarbage, v1::RunnerFailure::KIND_CRASHED, 0, 0, ""},
        BrokenRun{"ClosedPipe", kClosePipe, v1::RunnerFailure::KIND_EXTERNAL, SIGKILL, 0, ""}),
    [](const auto& test) { return test.param.name; });

class OutsideSignalTest : public WorkerProcessTest, public testing::WithParamInterface<int> {};

TEST_P(OutsideSignalTest, ToARunnerIsNotTheRunsFault) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  LeaseAndBegin(master, peer, 5, directory_ / "never");
  master.Lease(peer, 6, kComplete);
  kill(RunnersOf(*worker)[0], GetParam());
  const auto failed = master.AwaitResult(peer, 5);
  ASSERT_TRUE(failed.has_value()) << worker->Err();
  EXPECT_EQ(failed->failure().kind(), v1::RunnerFailure::KIND_EXTERNAL);
  EXPECT_EQ(failed->failure().signal(), GetParam());
  EXPECT_TRUE(master.AwaitResult(peer, 6).has_value());
}

INSTANTIATE_TEST_SUITE_P(Worker, OutsideSignalTest, testing::Values(SIGTERM, SIGKILL),
                         [](const auto& test) { return test.param == SIGTERM ? "Term" : "Kill"; });

TEST_F(WorkerProcessTest, CrashAmongShortRunsIsHeldAgainstTheRunThatCrashed) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  constexpr std::uint64_t kRuns = 60;
  const auto crashes = [](std::uint64_t fence) { return fence % 20 == 10; };
  for (std::uint64_t fence = 1; fence <= kRuns; ++fence) {
    master.Lease(peer, fence, crashes(fence) ? kAbort : kComplete);
  }
  std::set<std::uint64_t> answered;
  while (answered.size() < kRuns) {
    const auto answer = master.Await(v1::Envelope::kLeaseResult);
    ASSERT_TRUE(answer.has_value()) << worker->Err();
    const v1::LeaseResult& result = answer->envelope.lease_result();
    EXPECT_TRUE(answered.insert(result.fence()).second) << result.fence();
    EXPECT_EQ(result.has_failure(), crashes(result.fence())) << result.fence();
    if (result.has_failure()) {
      EXPECT_EQ(result.failure().stderr_tail(), "about to abort\n");
    }
  }
}

TEST_F(WorkerProcessTest, HeartbeatsKeepComingWhileARunSpins) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne(0.0, 0, 200);
  master.Lease(peer, 5, kSpin);
  for (int i = 0; i < 10; ++i) {
    const auto heartbeat = master.Await(v1::Envelope::kHeartbeat);
    ASSERT_TRUE(heartbeat.has_value());
    if (i >= 2) {
      EXPECT_THAT(heartbeat->envelope.heartbeat().held_leases(), ElementsAre(5));
    }
  }
}

TEST_F(WorkerProcessTest, RunnersAreNicerThanTheirSupervisor) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  master.WelcomeOne();
  ASSERT_TRUE(Eventually([&] { return RunnersOf(*worker).size() == 1; }, kDeadline));
  const auto niceness = [](pid_t pid) { return getpriority(PRIO_PROCESS, static_cast<id_t>(pid)); };
  EXPECT_TRUE(
      Eventually([&] { return niceness(RunnersOf(*worker)[0]) > niceness(worker->pid()); }, kDeadline));
}

TEST_F(WorkerProcessTest, SlotsRunAtTheSameTime) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker(2);
  const std::string peer = master.WelcomeOne();
  master.Lease(peer, 5, kWaitForFile, directory_ / "go");
  master.Lease(peer, 6, kComplete);
  ASSERT_TRUE(master.AwaitResult(peer, 6).has_value()) << "not held up by the first run";
  std::ofstream(directory_ / "go").close();
  EXPECT_TRUE(master.AwaitResult(peer, 5).has_value());
}

TEST_F(WorkerProcessTest, CancelledRunIsEndedWithoutAReport) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  master.Lease(peer, 5, kSpin);
  v1::Envelope cancel;
  cancel.mutable_cancel()->set_fence(5);
  master.Send(peer, cancel);
  master.Lease(peer, 6, kComplete);
  const auto first = master.Await(v1::Envelope::kLeaseResult);
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->envelope.lease_result().fence(), 6u);
}

TEST_F(WorkerProcessTest, KilledSupervisorLeavesNobodyBehind) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker(3);
  const std::string peer = master.WelcomeOne();
  master.Lease(peer, 5, kSpin);
  LeaseAndBegin(master, peer, 6, directory_ / "never");
  ASSERT_TRUE(Eventually([&] { return RunnersOf(*worker).size() == 3; }, kDeadline));
  ASSERT_TRUE(master.Await(v1::Envelope::kHeartbeat).has_value());
  const auto family = DescendantsOf(worker->pid());
  ASSERT_EQ(family.size(), 4u);
  worker->Signal(SIGKILL);
  worker->Wait();
  EXPECT_TRUE(AllGone(family));
}

TEST_F(WorkerProcessTest, KilledSupervisorLeavesNobodyBehindEvenIfTheyAreStopped) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker(2);
  master.WelcomeOne();
  ASSERT_TRUE(Eventually([&] { return RunnersOf(*worker).size() == 2; }, kDeadline));
  const auto family = DescendantsOf(worker->pid());
  for (const pid_t pid : family) kill(pid, SIGSTOP);
  worker->Signal(SIGKILL);
  worker->Wait();
  EXPECT_TRUE(AllGone(family));
}

TEST_F(WorkerProcessTest, KilledForkServerEndsTheWorkerWhichGivesItsLeasesBack) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker(2);
  const std::string peer = master.WelcomeOne();
  master.Lease(peer, 5, kSpin);
  ASSERT_TRUE(Eventually([&] { return RunnersOf(*worker).size() == 2; }, kDeadline));
  ASSERT_TRUE(master.Await(v1::Envelope::kHeartbeat).has_value());
  const auto family = DescendantsOf(worker->pid());
  kill(ChildrenOf(worker->pid())[0], SIGKILL);
  const auto given_back = master.AwaitResult(peer, 5);
  ASSERT_TRUE(given_back.has_value());
  EXPECT_EQ(given_back->failure().kind(), v1::RunnerFailure::KIND_EXTERNAL);
  EXPECT_EQ(worker->Wait(seconds(60)).exit_code, 4);
  EXPECT_TRUE(AllGone(family));
}

TEST_F(WorkerProcessTest, DeadRunnersAreReapedAndReplaced) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  std::set<pid_t> seen;
  for (std::uint64_t fence = 1; fence <= 5; ++fence) {
    master.Lease(peer, fence, kAbort);
    ASSERT_TRUE(master.AwaitResult(peer, fence).has_value());
    ASSERT_TRUE(Eventually([&] { return RunnersOf(*worker).size() == 1; }, kDeadline));
    seen.insert(RunnersOf(*worker)[0]);
  }
  EXPECT_EQ(seen.size(), 5u);
  // A zombie would still have an entry below the fork server.
  std::ifstream children("/proc/" + std::to_string(ChildrenOf(worker->pid())[0]) + "/task/" +
                         std::to_string(ChildrenOf(worker->pid())[0]) + "/children");
  if (children) {
    EXPECT_EQ(std::distance(std::istream_iterator<pid_t>(children), std::istream_iterator<pid_t>()), 1);
  }
}

TEST_F(WorkerProcessTest, RunnerThatCannotBeStartedIsLoggedOnceAndStartedLater) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  ASSERT_TRUE(Eventually([&] { return RunnersOf(*worker).size() == 1; }, kDeadline));
  const pid_t server = ChildrenOf(worker->pid())[0];
  rlimit usual{};
  rlimit none{};
  ASSERT_EQ(prlimit(server, RLIMIT_NOFILE, nullptr, &usual), 0);
  none.rlim_cur = 3;  // what it has already
  none.rlim_max = usual.rlim_max;
  ASSERT_EQ(prlimit(server, RLIMIT_NOFILE, &none, nullptr), 0);
  kill(RunnersOf(*worker)[0], SIGKILL);
  const std::string complaint = "cannot start a runner: Too many open files (too many open files? ulimit -n)";
  ASSERT_TRUE(Eventually([&] { return worker->Err().find(complaint) != std::string::npos; }, kDeadline))
      << worker->Err();
  ASSERT_EQ(prlimit(server, RLIMIT_NOFILE, &usual, nullptr), 0);
  master.Lease(peer, 5, kComplete);
  const auto result = master.AwaitResult(peer, 5);
  ASSERT_TRUE(result.has_value()) << worker->Err();
  EXPECT_FALSE(result->has_failure());
  const std::string log = worker->Err();
  EXPECT_EQ(log.find(complaint, log.find(complaint) + 1), std::string::npos) << log;
}

TEST_F(WorkerProcessTest, ManySlotsStartAndEndWithFewOpenFilesAllowedAtFirst) {
  FakeMaster master(access_path_, 1);
  // More than twice what a socket pair holds of the fork server's messages.
  const Process worker(
      {"/bin/sh", "-c",
       "ulimit -Sn 256; exec " + std::string(kFaultyWorker) + " '" + access_path_ + "' 600 600"});
  const std::string peer = master.WelcomeOne(0.0, 0, 600'000);
  ASSERT_NE(peer, "") << worker.Err();
  for (std::uint64_t fence = 1; fence <= 600; ++fence) master.Lease(peer, fence, kSleep, "");
  ASSERT_TRUE(Eventually([&] { return RunnersOf(worker).size() == 600; }, kDeadline)) << worker.Err();
  master.Drain(peer, false);  // ends all of them at once
  EXPECT_TRUE(master.Await(v1::Envelope::kLeaseResult).has_value()) << worker.Err();
}

TEST_F(WorkerProcessTest, SlotsThatNeedMoreOpenFilesThanAllowedAreRefused) {
  const ProcessResult ended = testing_support::RunProcess(
      {"/bin/sh", "-c",
       "ulimit -n 256; exec " + std::string(kFaultyWorker) + " '" + access_path_ + "' 100 600"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.err,
            "gauntlet-worker: 100 slots need up to 328 open files, and at most 256 are allowed here (ulimit "
            "-Hn): use fewer slots in each of several workers, or raise the limit\n");
}

TEST_F(WorkerProcessTest, DrainFinishesTheRunThenSaysGoodbye) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  LeaseAndBegin(master, peer, 5, directory_ / "go");
  master.Drain(peer, true);
  ASSERT_TRUE(master.Await(v1::Envelope::kHeartbeat).has_value());
  EXPECT_TRUE(worker->Running());
  std::ofstream(directory_ / "go").close();
  ASSERT_TRUE(master.AwaitResult(peer, 5).has_value());
  const auto goodbye = master.Await(v1::Envelope::kGoodbye);
  ASSERT_TRUE(goodbye.has_value());
  EXPECT_EQ(goodbye->envelope.goodbye().reason(), "the test is over");
  EXPECT_EQ(worker->Wait(seconds(60)).exit_code, 0);
}

TEST_F(WorkerProcessTest, SigtermLetsTheRunFinishAndLeavesNobodyBehind) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  LeaseAndBegin(master, peer, 5, directory_ / "go");
  const auto family = DescendantsOf(worker->pid());
  worker->Signal(SIGTERM);
  const auto leaving = master.Await(v1::Envelope::kDrain);
  ASSERT_TRUE(leaving.has_value());
  EXPECT_EQ(leaving->envelope.drain().reason(), "SIGTERM");
  std::ofstream(directory_ / "go").close();
  EXPECT_FALSE(master.AwaitResult(peer, 5)->has_failure());
  EXPECT_EQ(worker->Wait(seconds(60)).exit_code, 0);
  EXPECT_TRUE(AllGone(family));
}

TEST_F(WorkerProcessTest, CtrlCInTheWholeProcessGroupStillFinishesTheRun) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  LeaseAndBegin(master, peer, 5, directory_ / "go");
  kill(-worker->pid(), SIGINT);
  ASSERT_TRUE(master.Await(v1::Envelope::kDrain).has_value());
  std::ofstream(directory_ / "go").close();
  const auto result = master.AwaitResult(peer, 5);
  ASSERT_TRUE(result.has_value());
  EXPECT_FALSE(result->has_failure());
}

TEST_F(WorkerProcessTest, RefusedWorkerPrintsTheReasonAndExitsTwo) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const auto hello = master.Await(v1::Envelope::kHello);
  ASSERT_TRUE(hello.has_value());
  v1::Envelope refusal;
  refusal.mutable_refused()->set_reason("golden hash 2a is not 2b");
  master.Send(hello->peer, refusal);
  const ProcessResult ended = worker->Wait(seconds(60));
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.err, HasSubstr("golden hash 2a is not 2b"));
}

TEST_F(WorkerProcessTest, RunOutlivesItsMasterAndIsHandedToTheNextOne) {
  auto first = std::make_unique<FakeMaster>(access_path_, 1);
  const auto worker = StartWorker(2);
  std::string peer = first->WelcomeOne();
  first->Lease(peer, 5, kComplete);
  ASSERT_TRUE(first->Await(v1::Envelope::kLeaseResult).has_value());  // never acknowledged
  LeaseAndBegin(*first, peer, 6, directory_ / "go");
  const auto runners = RunnersOf(*worker);
  first.reset();

  FakeMaster second(access_path_, 2);
  const auto hello = second.Await(v1::Envelope::kHello);
  ASSERT_TRUE(hello.has_value()) << worker->Err();
  EXPECT_THAT(hello->envelope.hello().held_leases(), ElementsAre(5, 6));
  peer = second.WelcomeOne();
  EXPECT_TRUE(second.AwaitResult(peer, 5).has_value());
  EXPECT_EQ(RunnersOf(*worker), runners) << "the run went on undisturbed";
  std::ofstream(directory_ / "go").close();
  EXPECT_TRUE(second.AwaitResult(peer, 6).has_value());
}

TEST_F(WorkerProcessTest, BrokenConnectionMakesItSayHelloAgainLongBeforeItNoticesSilence) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  std::string peer = master.WelcomeOne(0.0, 0, 600'000);
  for (std::uint64_t fence = 5; fence < 7; ++fence) {  // it breaks twice
    master.Lease(peer, fence, kComplete);
    ASSERT_TRUE(master.Await(v1::Envelope::kLeaseResult).has_value());  // never acknowledged
    ASSERT_TRUE(master.BreakConnections());
    const auto hello = master.Await(v1::Envelope::kHello);
    ASSERT_TRUE(hello.has_value()) << worker->Err();
    EXPECT_THAT(hello->envelope.hello().held_leases(), testing::Contains(fence));
    peer = master.WelcomeOne(0.0, 0, 600'000);
    ASSERT_NE(peer, "");
    EXPECT_TRUE(master.AwaitResult(peer, fence).has_value()) << "sent again, it may have been lost";
  }
}

TEST_F(WorkerProcessTest, SuccessorIsSoughtAtItsFirstEndpointFirst) {
  auto former = std::make_unique<FakeMaster>(access_path_, 1);
  const auto worker = StartWorker();
  former->WelcomeOne();
  former.reset();
  FakeMaster first(directory_ / "first.json", 2);
  FakeMaster second(directory_ / "second.json", 2);
  WriteAccess(access_path_, 2, {first.endpoint(), second.endpoint()});
  EXPECT_NE(first.WelcomeOne(), "") << worker->Err();
  EXPECT_FALSE(second.Next(milliseconds(0)).has_value()) << "the first one had its turn later";
  // Nobody answers any more: the next one has its turn.
  EXPECT_TRUE(second.Await(v1::Envelope::kHello).has_value());
}

TEST_F(WorkerProcessTest, WaitsForAnAccessFileThatComesLate) {
  const auto worker = StartWorker();
  ASSERT_TRUE(Eventually([&] { return worker->Err().find("waiting for") != std::string::npos; }, kDeadline));
  FakeMaster master(access_path_, 1);
  EXPECT_NE(master.WelcomeOne(), "");
}

TEST_F(WorkerProcessTest, AnAccessFileThatCannotBeReadMayBeReadableLater) {
  std::filesystem::create_directory(access_path_);
  const auto worker = StartWorker();
  const auto complaints = [&] {
    const std::string log = worker->Err();
    const std::string complaint = "is no regular file";
    int count = 0;
    for (auto at = log.find(complaint); at != log.npos; at = log.find(complaint, at + 1)) ++count;
    return count;
  };
  ASSERT_TRUE(Eventually([&] { return complaints() == 1; }, kDeadline)) << worker->Err();
  std::filesystem::remove(access_path_);
  auto first = std::make_unique<FakeMaster>(access_path_, 1);
  ASSERT_NE(first->WelcomeOne(), "");
  // The same while it waits for a successor.
  first.reset();
  std::filesystem::remove(access_path_);
  std::filesystem::create_directory(access_path_);
  ASSERT_TRUE(Eventually([&] { return complaints() == 2; }, kDeadline)) << worker->Err();
  std::filesystem::remove(access_path_);
  FakeMaster second(access_path_, 2);
  EXPECT_NE(second.WelcomeOne(), "");
}

TEST_F(WorkerProcessTest, GivesUpWithoutAMasterAfterTheOrphanTimeout) {
  EXPECT_EQ(StartWorker(1, "0.3")->Wait(seconds(60)).exit_code, 3) << "no access.json";
  std::ofstream(access_path_)
      << R"({"format": 1, "campaign": "c0ffee", "epoch": 1, "endpoints": ["tcp://127.0.0.1:9"]})";
  EXPECT_EQ(StartWorker(1, "0.3")->Wait(seconds(60)).exit_code, 3) << "nobody listens";
}

TEST_F(WorkerProcessTest, BrokenAccessFileIsRefusedWithItsPlace) {
  std::ofstream(access_path_) << "{";
  const ProcessResult ended = StartWorker()->Wait(seconds(60));
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.err, HasSubstr(access_path_));
}

TEST_F(WorkerProcessTest, DirectoryOfAnotherCampaignEndsTheWorker) {
  auto first = std::make_unique<FakeMaster>(access_path_, 1);
  const auto worker = StartWorker();
  first->WelcomeOne();
  first.reset();
  FakeMaster other(access_path_, 2, "decaf");
  const ProcessResult ended = worker->Wait(seconds(60));
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.err, HasSubstr("campaign decaf"));
}

TEST_F(WorkerProcessTest, GarbageFromTheMasterIsLoggedOncePerKindAndHarmless) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  for (int i = 0; i < 20; ++i) master.SendRaw(peer, "\xff\xff garbage");
  master.Lease(peer, 5, kComplete);
  EXPECT_TRUE(master.AwaitResult(peer, 5).has_value());
  const std::string log = worker->Err();
  const std::size_t first = log.find("no envelope");
  ASSERT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find("no envelope", first + 1), std::string::npos) << log;
}

TEST_F(WorkerProcessTest, ResultBeyondTheMessageLimitComesWithoutItsTrajectory) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  master.Lease(peer, 5, kComplete, "", true);  // 20,000 ticks x 50 robots x 32 bytes = 32 MB
  const auto answer = master.AwaitResult(peer, 5);
  ASSERT_TRUE(answer.has_value());
  v1::RunResult result;
  ASSERT_TRUE(result.ParseFromString(answer->result()));
  EXPECT_FALSE(result.has_trajectory());
  EXPECT_EQ(result.fitness(), 0.5);
}

TEST_F(WorkerProcessTest, UnreadableSpecIsRefusedAsAResult) {
  FakeMaster master(access_path_, 1);
  const auto worker = StartWorker();
  const std::string peer = master.WelcomeOne();
  v1::Envelope envelope;
  envelope.mutable_lease()->set_fence(5);
  envelope.mutable_lease()->set_spec("\xff\xff");
  master.Send(peer, envelope);
  const auto answer = master.AwaitResult(peer, 5);
  ASSERT_TRUE(answer.has_value());
  v1::RunResult result;
  ASSERT_TRUE(result.ParseFromString(answer->result()));
  EXPECT_EQ(result.verdict(), v1::VERDICT_REFUSED);
  EXPECT_EQ(result.message(), "spec: 2 bytes that are no RunSpec");
}

TEST_F(WorkerProcessTest, DieWithParentMeansTheWholeFamily) {
  FakeMaster master(access_path_, 1);
  // A shell as the parent; `wait` keeps it there.
  Process parent({"/bin/sh", "-c",
                  std::string(kFaultyWorker) + " '" + access_path_ + "' 2 600 --die-with-parent & wait"});
  const auto hello = master.Await(v1::Envelope::kHello);
  ASSERT_TRUE(hello.has_value()) << parent.Err();
  ASSERT_TRUE(Eventually([&] { return DescendantsOf(parent.pid()).size() == 4; }, kDeadline));
  const auto family = DescendantsOf(parent.pid());
  parent.Signal(SIGKILL);
  parent.Wait();
  EXPECT_TRUE(AllGone(family));
}

}  // namespace
}  // namespace gauntlet::worker
