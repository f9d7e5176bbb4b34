// Real processes that want one campaign at the same moment.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <vector>

#include "master/directory/campaign_lock.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

constexpr int kWon = 10;
constexpr int kRefused = 11;

// Waits for the gun, tries, and as a winner holds on until it is killed.
[[noreturn]] void Compete(const std::string& path, int gun, int answers) {
  char byte = 0;
  (void)!read(gun, &byte, 1);  // ends when the parent closes its end
  Result<std::unique_ptr<CampaignLock>> lock = CampaignLock::Acquire(path, "camp");
  const bool won = lock.ok();
  const bool well_refused = !won && lock.error().kind == ErrorKind::kInUse &&
                            lock.error().message.find("living master (host ") != std::string::npos;
  byte = static_cast<char>(won ? kWon : well_refused ? kRefused : 0);
  (void)!write(answers, &byte, 1);
  if (won) pause();
  _exit(0);
}

// The answers of `count` competitors, all of them dead at the end.
std::vector<int> Race(const std::string& path, int count) {
  std::array<int, 2> gun{};
  std::array<int, 2> answers{};
  EXPECT_EQ(pipe(gun.data()), 0);
  EXPECT_EQ(pipe(answers.data()), 0);
  std::vector<pid_t> children;
  for (int i = 0; i < count; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      close(gun[1]);
      close(answers[0]);
      Compete(path, gun[0], answers[1]);
    }
    children.push_back(child);
  }
  close(gun[0]);
  close(answers[1]);
  close(gun[1]);
  std::vector<int> results;
  char byte = 0;
  while (results.size() < children.size() && read(answers[0], &byte, 1) == 1) results.push_back(byte);
  close(answers[0]);
  for (const pid_t child : children) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  return results;
}

TEST(CampaignLockRace, ExactlyOneOfManyProcessesWins) {
  const ScratchDirectory scratch;
  // In every round but the first, the lock still names the winner of the round before, who was killed.
  for (int round = 0; round < 15; ++round) {
    const std::vector<int> results = Race(scratch / "lock", 6);
    ASSERT_EQ(results.size(), 6u);
    EXPECT_EQ(std::count(results.begin(), results.end(), kWon), 1) << "round " << round;
    EXPECT_EQ(std::count(results.begin(), results.end(), kRefused), 5) << "round " << round;
  }
}

TEST(CampaignLockRace, AFrozenOwnerKeepsIt) {
  const ScratchDirectory scratch;
  std::array<int, 2> answers{};
  ASSERT_EQ(pipe(answers.data()), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) Compete(scratch / "lock", open("/dev/null", O_RDONLY | O_CLOEXEC), answers[1]);
  char byte = 0;
  ASSERT_EQ(read(answers[0], &byte, 1), 1);
  ASSERT_EQ(byte, kWon);
  kill(child, SIGSTOP);
  int status = 0;
  waitpid(child, &status, WUNTRACED);
  Result<std::unique_ptr<CampaignLock>> lock = CampaignLock::Acquire(scratch / "lock", "camp");
  ASSERT_FALSE(lock.ok());
  EXPECT_NE(lock.error().message.find("pid " + std::to_string(child)), std::string::npos)
      << lock.error().message;
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(CampaignLock::Acquire(scratch / "lock", "camp").ok());
  close(answers[0]);
  close(answers[1]);
}

}  // namespace
}  // namespace gauntlet
