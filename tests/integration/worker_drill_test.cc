// Workers that freeze, lag, answer late, twice or wrongly: the campaign ends as if nothing had been.
// Covers: worker/connection.cc, worker/main.cc
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <set>

#include "base/system/process_identity.h"
#include "tests/integration/campaign_database.h"
#include "tests/integration/crowd_drill.h"
#include "tests/integration/scripted_worker.h"
#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr std::uint64_t kFirstWorker = 0x1111;
constexpr std::uint64_t kSecondWorker = 0x2222;

class WorkerDrill : public testing::Test {
 protected:
  void Begin(int generations) {
    campaign_.generations = generations;
    runs_ = campaign_.population * (generations + 1);
    hash_ = UndisturbedHash(campaign_);
    master_ = StartGauntlet(MasterArguments(campaign_, dir_));
  }
  // From now on, until the log says that a worker is lost.
  void ExpectLossWithin(double most_seconds) {
    const auto begun = std::chrono::steady_clock::now();
    ASSERT_TRUE(LogBecomes(dir_, "worker-lost"));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    RecordProperty("noticed_after_seconds", fmt::format("{:.3f}", seconds));
    fmt::print("the loss was noticed after {:.3f} s\n", seconds);
    EXPECT_LT(seconds, most_seconds);
  }
  // The master ends by itself, with the result of an undisturbed campaign and every run stored once.
  void ExpectTheUndisturbedResult() {
    const ProcessResult result = master_->Wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(StateHash(dir_), hash_);
    EXPECT_EQ(StoredRuns(dir_).size(), Show(dir_).value("runs_done", 0U));
  }

  TemporaryDirectory scratch_;
  std::string dir_ = scratch_ / "c";
  SmallCampaign campaign_;
  int runs_ = 0;
  std::string hash_;
  std::unique_ptr<Process> master_;
};

TEST_F(WorkerDrill, AFrozenWorkersRunsGoElsewhereWithin3HeartbeatsAndItIsTakenBack) {
  Begin(5);
  const std::unique_ptr<Process> frozen = StartSlowWorker(dir_, 300);
  const std::unique_ptr<Process> other = StartSlowWorker(dir_, 300);
  ASSERT_TRUE(RunsDone(dir_, 2));
  ASSERT_TRUE(WorkersBusy(dir_, 2));
  SignalFamily(*frozen, SIGSTOP);
  // Three heartbeats of a second, and the time to read the log on a busy machine.
  ExpectLossWithin(3.4);
  // Unless they had been already, as copies of runs that take long.
  ASSERT_TRUE(StatusBecomes(dir_, [](const json& status) {
    return status.value("leased_again", 0) + status.value("copies", 0) > 0;
  }));
  // Its runs are given to the other; then it wakes, and is told to drop what they have finished.
  const int done = StatusOf(dir_).value("runs_done", 0);
  ASSERT_TRUE(RunsDone(dir_, done + 2));
  SignalFamily(*frozen, SIGCONT);
  EXPECT_TRUE(StatusBecomes(dir_, [](const json& status) { return status.value("workers", 0) == 2; }));
  ExpectTheUndisturbedResult();
}

TEST_F(WorkerDrill, AKilledWorkersRunsGoElsewhereWithinASecond) {
  campaign_.generations = 4;
  hash_ = UndisturbedHash(campaign_);
  master_ = StartGauntlet(EvolveArguments(campaign_, dir_, 2), {"GAUNTLET_WORKER=" + WorkerPath() + "-slow",
                                                                "GAUNTLET_TEST_RUN_MILLISECONDS=200"});
  pid_t busy = 0;
  ASSERT_TRUE(StatusBecomes(dir_, [&](const json& status) {
    for (const json& worker : status.at("worker_list")) {
      if (!worker.at("runs").empty()) busy = worker.at("pid");
    }
    return busy != 0;
  }));
  ASSERT_EQ(kill(busy, SIGKILL), 0);
  ExpectLossWithin(1.0);
  ExpectTheUndisturbedResult();
}

// The same for workers that somebody else has started on the master's machine.
TEST_F(WorkerDrill, AKilledForeignWorkersRunsGoElsewhereWithinASecondToo) {
  Begin(4);
  const std::unique_ptr<Process> first = StartSlowWorker(dir_, 200);
  const std::unique_ptr<Process> second = StartSlowWorker(dir_, 200);
  ASSERT_TRUE(WorkersBusy(dir_, 2));
  first->Signal(SIGKILL);
  ExpectLossWithin(1.0);
  // Between two generations it may have had nothing.
  if (MasterLog(dir_).find("is lost; 0 of its runs") == std::string::npos) {
    EXPECT_TRUE(StatusBecomes(dir_, [](const json& status) { return status.value("leased_again", 0) > 0; }));
  }
  ExpectTheUndisturbedResult();
}

// What is watched is the process: its connection may break and come back, and its goodbye is no death.
TEST_F(WorkerDrill, AReconnectAndAGoodbyeAreNoLoss) {
  Begin(3);
  ScriptedWorker worker(dir_, kFirstWorker);
  worker.hello().process = IdentifyThisProcess();
  ASSERT_TRUE(worker.Join());
  const auto kept = worker.HearA<proto::Lease>();
  ASSERT_TRUE(kept);
  worker.hello().held_leases = {kept->fence};
  ASSERT_TRUE(worker.Join()) << "on a new connection; the old one is gone";
  const std::unique_ptr<Process> leaving = StartSlowWorker(dir_, 50);
  ASSERT_TRUE(StatusBecomes(dir_, [&](const json& status) {
    worker.Beat({kept->fence});
    return status.value("runs_done", 0) >= 3;
  }));
  leaving->Signal(SIGTERM);
  EXPECT_EQ(leaving->Wait().exit_code, 0);
  worker.Say(ScriptedWorker::Answer(*kept));
  EXPECT_TRUE(worker.HearA<proto::Acknowledge>());
  worker.Say(proto::Goodbye{"enough"});
  const std::unique_ptr<Process> last = StartWorker(dir_);
  ExpectTheUndisturbedResult();
  EXPECT_THAT(MasterLog(dir_), testing::Not(HasSubstr("worker-lost")));
}

// Its run was given away while it was frozen, and nobody has finished it: it brings its answer first.
TEST_F(WorkerDrill, AnAnswerThatAFrozenWorkerBringsBeforeTheOtherCountsFirst) {
  Begin(3);
  const std::unique_ptr<Process> frozen = StartSlowWorker(dir_, 1000);
  ASSERT_TRUE(WorkersBusy(dir_, 1));
  frozen->Signal(SIGSTOP);  // its supervisor alone: the runner ends the run meanwhile
  ASSERT_TRUE(LogBecomes(dir_, "worker-lost"));
  ScriptedWorker other(dir_, kSecondWorker);
  ASSERT_TRUE(other.Join());
  const auto given = other.HearA<proto::Lease>();
  ASSERT_TRUE(given);
  frozen->Signal(SIGCONT);
  const auto cancelled = other.HearA<proto::Cancel>();
  ASSERT_TRUE(cancelled) << "the other need not go on";
  EXPECT_EQ(cancelled->fence, given->fence);
  other.Say(proto::Goodbye{"enough"});
  const std::unique_ptr<Process> last = StartWorker(dir_);
  ExpectTheUndisturbedResult();
}

TEST_F(WorkerDrill, ASlowWorkerBesideAFastOneChangesNothing) {
  Begin(4);
  const std::unique_ptr<Process> slow = StartSlowWorker(dir_, 250);
  ASSERT_TRUE(LogBecomes(dir_, "worker-joined"));
  const std::unique_ptr<Process> fast = StartWorker(dir_);
  ExpectTheUndisturbedResult();
  EXPECT_THAT(MasterLog(dir_), testing::Not(HasSubstr("worker-lost")));
}

// Every answer is sent twice, every third a third time after the next; one is kept until its lease was given
// away and another worker has answered.
TEST_F(WorkerDrill, LateAndRepeatedAnswersAreComparedAndCountOnce) {
  Begin(3);
  ScriptedWorker first(dir_, kFirstWorker);
  ASSERT_TRUE(first.Join());
  const auto kept = first.HearA<proto::Lease>();
  ASSERT_TRUE(kept);
  ASSERT_TRUE(LogBecomes(dir_, "worker-lost")) << "silent from now on";

  ScriptedWorker second(dir_, kSecondWorker);
  ASSERT_TRUE(second.Join());
  std::map<std::uint64_t, int> leased;
  std::string former;
  bool handed_in = false;
  while (master_->Running()) {
    const auto lease = second.HearA<proto::Lease>(milliseconds(200));
    if (!lease) continue;
    ++leased[lease->run_id];
    const proto::LeaseResult answer = ScriptedWorker::Answer(*lease);
    second.Say(answer);
    second.Say(answer);
    if (lease->run_id % 3 == 0) second.Say(answer);
    if (!handed_in && leased.contains(kept->run_id) && leased.size() > 3) {
      handed_in = true;
      EXPECT_EQ(leased[kept->run_id], 1) << "leased again when its worker was lost";
      first.Say(ScriptedWorker::Answer(*kept));
      EXPECT_TRUE(first.HearA<proto::Acknowledge>()) << "a late answer is acknowledged like any other";
    }
  }
  EXPECT_TRUE(handed_in);
  for (const auto& [run, times] : leased) EXPECT_EQ(times, 1) << "run " << run;
  ExpectTheUndisturbedResult();
  EXPECT_FALSE(Show(dir_).value("nondeterministic", true));
}

TEST_F(WorkerDrill, TwoAnswersThatDifferMarkTheCampaignAndNameBothWorkers) {
  Begin(3);
  ScriptedWorker broken(dir_, kFirstWorker);
  ASSERT_TRUE(broken.Join());
  const auto kept = broken.HearA<proto::Lease>();
  ASSERT_TRUE(kept);
  ASSERT_TRUE(LogBecomes(dir_, "worker-lost"));
  const std::unique_ptr<Process> sound = StartSlowWorker(dir_, 100);
  ASSERT_TRUE(RunsDone(dir_, 8));
  broken.Say(ScriptedWorker::WrongAnswer(*kept));
  ASSERT_TRUE(LogBecomes(dir_, "nondeterministic"));
  EXPECT_THAT(MasterLog(dir_), HasSubstr(fmt::format("run {} ended differently", kept->run_id)));
  EXPECT_THAT(MasterLog(dir_), HasSubstr("0000000000001111@scripted gave"));
  EXPECT_EQ(master_->Wait().exit_code, 1);
  EXPECT_TRUE(Show(dir_).value("nondeterministic", false));
  EXPECT_EQ(StatusOf(dir_).at("nondeterministic"), 1);
}

// What an eavesdropper of the first master's time could send to the second: results, heartbeats and a hello
// of then, from a stranger and from a worker that said hello.
TEST_F(WorkerDrill, MessagesOfAnEarlierMasterChangeNothing) {
  Begin(3);
  std::vector<proto::LeaseResult> recorded;
  {
    ScriptedWorker early(dir_, kFirstWorker);
    ASSERT_TRUE(early.Join());
    for (std::size_t acknowledged = 0; acknowledged < 5;) {
      const auto message = early.Hear();
      ASSERT_TRUE(message);
      if (const auto* acknowledge = std::get_if<proto::Acknowledge>(&*message))
        acknowledged += acknowledge->fences.size();
      if (const auto* lease = std::get_if<proto::Lease>(&*message); lease != nullptr && recorded.size() < 5) {
        recorded.push_back(ScriptedWorker::Answer(*lease));
        early.Say(recorded.back());
      }
    }
  }
  master_->Signal(SIGKILL);
  master_->Wait();
  master_ = StartGauntlet(ResumeArguments(dir_));

  ScriptedWorker stranger(dir_, kSecondWorker);
  ASSERT_TRUE(stranger.Connect(2)) << master_->Err();
  for (const proto::LeaseResult& result : recorded) stranger.Say(result);
  stranger.Beat({recorded.front().fence});
  const auto hears = [&] {
    EXPECT_FALSE(stranger.Hear(milliseconds(300))) << "who has not said hello is not answered";
    return MasterLog(dir_).find("a peer that has not said hello sent a message") != std::string::npos;
  };
  EXPECT_TRUE(Eventually(hears, kPatience)) << MasterLog(dir_);

  ScriptedWorker again(dir_, kFirstWorker);
  ASSERT_TRUE(again.Join(2));
  std::set<std::uint64_t> acknowledged;
  for (const proto::LeaseResult& result : recorded) acknowledged.insert(result.run_id);
  for (const proto::LeaseResult& result : recorded) again.Say(result);
  while (master_->Running()) {
    const auto lease = again.HearA<proto::Lease>(milliseconds(200));
    if (!lease) continue;
    EXPECT_FALSE(acknowledged.contains(lease->run_id)) << "run " << lease->run_id << " was acknowledged";
    again.Say(ScriptedWorker::Answer(*lease));
  }
  ExpectTheUndisturbedResult();
}

// The long form, with 64 workers for ten minutes, is a LongDrill.
TEST_F(WorkerDrill, ACrowdOfWorkersUnderFullLoadIsNeverTakenForLost) {
  const CrowdReport report = WatchACrowd(dir_, 24, std::chrono::seconds(4));
  fmt::print("{} workers, load {:.1f}: {} runs\n", report.joined, report.load, report.runs);
  EXPECT_EQ(report.joined, 24);
  EXPECT_EQ(report.lost, 0);
  EXPECT_EQ(report.leased_again, 0);
}

TEST_F(WorkerDrill, AMasterThatFreezesAndWakesTakesNobodyForLost) {
  Begin(4);
  const std::unique_ptr<Process> workers[] = {StartSlowWorker(dir_, 200), StartSlowWorker(dir_, 200)};
  ASSERT_TRUE(RunsDone(dir_, 4));
  master_->Signal(SIGSTOP);
  // Longer than the silence after which a worker counts as lost.
  Eventually([] { return false; }, milliseconds(4500));
  master_->Signal(SIGCONT);
  ExpectTheUndisturbedResult();
  for (const auto& worker : workers) EXPECT_EQ(worker->Wait().exit_code, 0) << worker->Err();
  EXPECT_THAT(MasterLog(dir_), testing::Not(HasSubstr("worker-lost")));
}

}  // namespace
}  // namespace gauntlet::testing_support
