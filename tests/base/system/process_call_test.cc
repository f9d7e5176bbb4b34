#include "base/system/process_call.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

TEST(CallProcess, CarriesInputOutputErrorsAndExitCode) {
  const Result<CallOutput> output =
      CallProcess({"/bin/sh", "-c", "cat; echo oops >&2; exit 3"}, "hello", {.deadline = seconds(20)});
  ASSERT_TRUE(output.ok()) << output.error().message;
  EXPECT_EQ(output->out, "hello");
  EXPECT_EQ(output->err, "oops\n");
  EXPECT_EQ(output->exit_code, 3);
}

TEST(CallProcess, MoreThanAPipeHoldsPassesBothWays) {
  const std::string big(1 << 20, 'x');
  const Result<CallOutput> output = CallProcess({"/bin/cat"}, big, {.deadline = seconds(20)});
  ASSERT_TRUE(output.ok()) << output.error().message;
  EXPECT_EQ(output->out, big);
}

TEST(CallProcess, KeepsAsMuchAsItIsAskedFor) {
  constexpr std::size_t kSize = std::size_t{20} << 20;
  const std::vector<std::string> talker = {"/usr/bin/head", "-c", std::to_string(kSize), "/dev/zero"};
  const Result<CallOutput> some = CallProcess(talker, "", {.deadline = seconds(20)});
  ASSERT_TRUE(some.ok()) << some.error().message;
  EXPECT_EQ(some->out.size(), std::size_t{16} << 20);
  const Result<CallOutput> all = CallProcess(talker, "", {.part_of_us = true, .most_output = 2 * kSize});
  ASSERT_TRUE(all.ok()) << all.error().message;
  EXPECT_EQ(all->out.size(), kSize);
}

TEST(CallProcess, AProgramThatReadsNothingDoesNoHarm) {
  const Result<CallOutput> output =
      CallProcess({"/bin/true"}, std::string(1 << 20, 'x'), {.deadline = seconds(20)});
  ASSERT_TRUE(output.ok()) << output.error().message;
  EXPECT_EQ(output->exit_code, 0);
}

TEST(CallProcess, EndsWhatDoesNotEnd) {
  const auto before = std::chrono::steady_clock::now();
  const Result<CallOutput> output = CallProcess({"/bin/sleep", "600"}, "", {.deadline = milliseconds(200)});
  ASSERT_FALSE(output.ok());
  EXPECT_EQ(output.error().message, "cannot call /bin/sleep: no answer within 200 ms");
  EXPECT_LT(std::chrono::steady_clock::now() - before, seconds(60));
}

TEST(CallProcess, NamesAProgramThatIsNotThere) {
  const Result<CallOutput> output = CallProcess({"sbatch-that-is-nowhere"}, "", {.deadline = seconds(5)});
  ASSERT_FALSE(output.ok());
  EXPECT_EQ(output.error().kind, ErrorKind::kNotFound);
  EXPECT_EQ(output.error().message, "there is no sbatch-that-is-nowhere");
}

TEST(CallProcess, GetsTheVariablesThatItMayInherit) {
  setenv("GAUNTLET_SECRET", "77", 1);
  setenv("GAUNTLET_OPEN", "88", 1);
  const CallOptions options = {.deadline = seconds(20), .inherits = [](std::string_view entry) {
                                 return !entry.starts_with("GAUNTLET_SECRET=");
                               }};
  const Result<CallOutput> output = CallProcess({"/usr/bin/env"}, "", options);
  unsetenv("GAUNTLET_SECRET");
  unsetenv("GAUNTLET_OPEN");
  ASSERT_TRUE(output.ok());
  EXPECT_THAT(output->out, testing::Not(HasSubstr("GAUNTLET_SECRET")));
  EXPECT_THAT(output->out, HasSubstr("GAUNTLET_OPEN=88"));
}

}  // namespace
}  // namespace gauntlet
