#include "master/session/master_log.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "tests/support/process.h"

namespace gauntlet {
namespace {

class MasterLogTest : public testing::Test {
 protected:
  ~MasterLogTest() override {
    spdlog::set_default_logger(before_);
    spdlog::set_level(spdlog::level::info);
  }

  std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
  testing_support::TemporaryDirectory scratch_;
  std::string file_ = scratch_ / "master.log";
};

// Two threads, as the master and its metrics server are.
TEST_F(MasterLogTest, Keeps4FormerFilesAndLosesAndTearsNoLine) {
  constexpr int kLines = 4000;
  constexpr std::size_t kBytes = 128 << 10;
  const auto log = [](const char* who, int count) {
    for (int i = 0; i < count; ++i) {
      spdlog::info("run-failure: run {} crashed (lease {:x}) {} {}", i, (1ULL << 32) + i, who, i);
    }
  };
  ASSERT_TRUE(OpenMasterLog(file_, {kBytes, 4}).ok());
  std::thread other(log, "other", kLines);
  log("this", kLines);
  other.join();

  std::map<std::string, std::vector<int>> numbers;  // in the order of the files, oldest first
  for (const char* name : {"master.4.log", "master.3.log", "master.2.log", "master.1.log", "master.log"}) {
    ASSERT_TRUE(std::filesystem::exists(scratch_ / name)) << name;
    EXPECT_LE(std::filesystem::file_size(scratch_ / name), kBytes) << name;
    std::ifstream file(scratch_ / name);
    for (std::string line; std::getline(file, line);) {
      ASSERT_THAT(line, testing::ContainsRegex(
                            "^\\[....-..-.. ..:..:..[.]...\\] \\[master\\] \\[info\\] run-failure: "
                            "run [0-9]+ crashed .lease 1[0-9a-f]+. (this|other) [0-9]+$"));
      const std::size_t last = line.rfind(' ');
      const std::size_t who = line.rfind(' ', last - 1);
      numbers[line.substr(who + 1, last - who - 1)].push_back(std::atoi(line.c_str() + last));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "master.5.log"));
  std::size_t kept = 0;
  for (const auto& [who, lines] : numbers) {
    kept += lines.size();
    for (std::size_t i = 0; i < lines.size(); ++i) {
      ASSERT_EQ(lines[i], kLines - static_cast<int>(lines.size() - i)) << who << ": missing or out of order";
    }
  }
  EXPECT_GT(kept, 4u * kBytes / 110) << "what fits is kept";
}

TEST_F(MasterLogTest, WithoutAFileItIsSilent) {
  ASSERT_TRUE(OpenMasterLog("/proc/none/master.log").ok());
  EXPECT_FALSE(spdlog::default_logger()->should_log(spdlog::level::critical));
}

// What docs/operations.md says.
TEST_F(MasterLogTest, TakesAtMost80Mebibytes) {
  const LogLimits limits;
  EXPECT_EQ(limits.bytes * (limits.former + 1), std::size_t{80} << 20);
}

}  // namespace
}  // namespace gauntlet
