// Master and workers in network namespaces of their own, joined by a cable that is cut and mended: whole, and
// in one direction.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/integration/campaign_database.h"
#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using testing::HasSubstr;

// A shell in namespaces of its own (network, mounts, pids) obeys commands that come through a pipe; when it
// dies, so does everything in there.
class NetworkCut : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(RunProcess({"/usr/bin/mkfifo", fifo_}).exit_code, 0);
    const std::string script = fmt::format(
        "mount -t tmpfs none /run && ip link set lo up && ip netns add far && "
        "ip link add near type veth peer name far netns far && ip address add 10.77.0.1/24 dev near && "
        "ip -n far address add 10.77.0.2/24 dev far && ip link set near up && ip -n far link set far up && "
        "iptables -L INPUT -n >/dev/null || exit 77\n"
        "echo ready > {1}\n"
        "exec 9<>{0}\n"
        "while read -r line <&9; do eval \"$line\"; echo $? >> {1}; done",
        fifo_, answers_);
    shell_ = std::make_unique<Process>(
        std::vector<std::string>{"/usr/bin/unshare", "--map-root-user", "--net", "--mount", "--pid", "--fork",
                                 "--kill-child", "--mount-proc", "/bin/sh", "-c", script});
    ASSERT_TRUE(Eventually([&] { return ReadFile(answers_) == "ready\n" || !shell_->Running(); }, kPatience));
    if (!shell_->Running())
      GTEST_SKIP() << "no network namespaces, or no iptables, to be had here: " << shell_->Err();
    campaign_.generations = 3;
    hash_ = UndisturbedHash(campaign_);
  }

  // One line for the shell; waits until it has been done.
  void Do(const std::string& command) {
    const std::size_t before = ReadFile(answers_).size();
    std::ofstream(fifo_) << command << std::endl;
    ASSERT_TRUE(Eventually([&] { return ReadFile(answers_).size() > before; }, kPatience));
    EXPECT_EQ(ReadFile(answers_).substr(before), "0\n") << command << shell_->Err();
  }
  // Runs long enough that the campaign outlasts the cut.
  void Begin() {
    std::string master = GauntletPath();
    for (const std::string& argument : MasterArguments(campaign_, dir_, "tcp://10.77.0.1:*"))
      master += " '" + argument + "'";
    Do(fmt::format("({} > {}/out 2> {}/err; echo $? > {}/exit) &", master, scratch_.path(), scratch_.path(),
                   scratch_.path()));
    for (int i = 0; i < 2; ++i) {
      Do(fmt::format(
          "GAUNTLET_TEST_RUN_MILLISECONDS=150 ip netns exec far {}-slow --dir {} --orphan-timeout 60 &",
          WorkerPath(), dir_));
    }
    ASSERT_TRUE(RunsDone(dir_, 4)) << ReadFile(scratch_ / "err");
    EXPECT_TRUE(StatusOf(dir_).at("master").at("encrypted"));
  }
  void ExpectTheUndisturbedResult() {
    ASSERT_TRUE(Eventually([&] { return !ReadFile(scratch_ / "exit").empty(); }, kPatience));
    EXPECT_EQ(ReadFile(scratch_ / "exit"), "0\n") << ReadFile(scratch_ / "err");
    EXPECT_EQ(StateHash(dir_), hash_);
    EXPECT_EQ(StoredRuns(dir_).size(), Show(dir_).value("runs_done", 0U));
  }
  // Nobody is reached for longer than the silence that makes a worker lost; then it goes on.
  void ExpectSilenceBetween(const std::string& cut, const std::string& mend) {
    Begin();
    Do(cut);
    ASSERT_TRUE(LogBecomes(dir_, "worker-lost"));
    ASSERT_TRUE(StatusBecomes(dir_, [](const json& status) { return status.value("workers", -1) == 0; }));
    EXPECT_THAT(StatusOf(dir_).at("why_nothing_runs"), HasSubstr("silent now"));
    Do(mend);
    ExpectTheUndisturbedResult();
  }

  TemporaryDirectory scratch_;
  std::string fifo_ = scratch_ / "commands";
  std::string answers_ = scratch_ / "answers";
  std::string dir_ = scratch_ / "c";
  SmallCampaign campaign_;
  std::string hash_;
  std::unique_ptr<Process> shell_;
};

TEST_F(NetworkCut, ACableThatIsPulledAndPluggedInAgain) {
  ExpectSilenceBetween("ip link set near down", "ip link set near up");
}

TEST_F(NetworkCut, WorkersHearTheMasterAndAreNotHeard) {
  ExpectSilenceBetween("iptables -A INPUT -i near -j DROP", "iptables -D INPUT -i near -j DROP");
}

// The master hears heartbeats and takes nobody for lost; what it sends is lost. Workers find out.
TEST_F(NetworkCut, TheMasterHearsItsWorkersAndIsNotHeard) {
  Begin();
  Do("iptables -A OUTPUT -o near -j DROP");
  // Longer than the silence after which workers look for another master.
  Eventually([] { return false; }, milliseconds(5000));
  Do("iptables -D OUTPUT -o near -j DROP");
  ExpectTheUndisturbedResult();
}

}  // namespace
}  // namespace gauntlet::testing_support
