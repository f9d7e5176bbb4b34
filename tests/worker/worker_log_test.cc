#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/support/process.h"
#include "worker/worker_process.h"

namespace gauntlet::worker {
namespace {

// Puts the process' logger back.
class WorkerLogTest : public testing::Test {
 protected:
  ~WorkerLogTest() override { spdlog::set_default_logger(before_); }

  // The numbers at the ends of the lines; a line that is not whole is a failure.
  static std::vector<int> NumbersIn(const std::string& path) {
    std::vector<int> numbers;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
      EXPECT_THAT(line,
                  testing::MatchesRegex(
                      "....-..-.. ..:..:..[.]... worker [0-9]+ info: run [0-9]+, lease 1[0-9a-f]+: [0-9]+"));
      const std::size_t last = line.rfind(' ');
      if (last != std::string::npos) numbers.push_back(std::atoi(line.c_str() + last));
    }
    return numbers;
  }
  static void Log(int first, int count) {
    for (int i = first; i < first + count; ++i)
      spdlog::info("run {}, lease {:x}: {}", i, (1ULL << 32) + i, i);
  }

  std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
  testing_support::TemporaryDirectory scratch_;
  std::string file_ = scratch_ / "worker-1.log";
};

TEST_F(WorkerLogTest, KeepsOneFormerFileAndTheNewestLinesWhole) {
  constexpr int kLines = 3000;
  constexpr std::size_t kBytes = 64 << 10;
  ASSERT_TRUE(StartLogging(file_, false, {kBytes, 1}).ok());
  Log(0, kLines);
  EXPECT_LE(std::filesystem::file_size(file_), kBytes);
  EXPECT_LE(std::filesystem::file_size(scratch_ / "worker-1.1.log"), kBytes);
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "worker-1.2.log"));

  std::vector<int> numbers = NumbersIn(scratch_ / "worker-1.1.log");
  EXPECT_GT(numbers.size(), 500u);
  const std::vector<int> newer = NumbersIn(file_);
  numbers.insert(numbers.end(), newer.begin(), newer.end());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    ASSERT_EQ(numbers[i], kLines - static_cast<int>(numbers.size() - i))
        << "a line is missing or out of order";
  }
}

TEST_F(WorkerLogTest, AWorkerThatTakesAnothersPlaceGoesOnInItsFile) {
  ASSERT_TRUE(StartLogging(file_, false).ok());
  Log(0, 10);
  ASSERT_TRUE(StartLogging(file_, false).ok());
  Log(10, 10);
  EXPECT_THAT(NumbersIn(file_), testing::SizeIs(20));
}

TEST_F(WorkerLogTest, QuietLeavesOutWhatIsNoWarning) {
  ASSERT_TRUE(StartLogging(file_, true).ok());
  Log(0, 10);
  EXPECT_EQ(std::filesystem::file_size(file_), 0u);
}

TEST_F(WorkerLogTest, NamesAFileThatCannotBeOpened) {
  const std::string place = file_ + "/x";
  std::ofstream{file_};  // a file where a directory would have to be
  const Status started = StartLogging(place, false);
  ASSERT_FALSE(started.ok());
  EXPECT_THAT(started.error().message, testing::HasSubstr(file_));
}

// What docs/operations.md says.
TEST_F(WorkerLogTest, TakesAtMost8MebibytesPerWorker) {
  const LogLimits limits;
  EXPECT_EQ(limits.bytes * (limits.former + 1), std::size_t{8} << 20);
}

}  // namespace
}  // namespace gauntlet::worker
