#include "cli/output/progress.h"

#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "analysis/tables/table.h"
#include "tests/support/fake_clock.h"

namespace gauntlet {
namespace {

CampaignProgress Halfway() {
  CampaignProgress progress;
  progress.search.generation = 12;
  progress.search.generations = 50;
  progress.each.Add(progress.search);
  progress.runs_done = 1240;
  progress.runs_planned = 2480;
  progress.runs_per_second = 23.4;
  progress.best_fitness = 0.0;
  progress.mean_fitness = 0.413;
  progress.total_failures = 37;
  progress.workers.connected = 2;
  progress.workers.busy = 1;
  progress.remaining_seconds = 53.0;
  return progress;
}

TEST(LiveProgressLine, ShowsEverythingOnAWideTerminal) {
  EXPECT_EQ(LiveProgressLine(Halfway(), 160),
            "gen 12/50  [============>           ]  1,240/2,480 runs  23/s  best 0.000 mean 0.413  "
            "37 total failures  workers 1/2 busy  53 s left");
}

TEST(LiveProgressLine, LeavesOutWhatMattersLeastFirst) {
  const std::string line = LiveProgressLine(Halfway(), 80);
  EXPECT_EQ(line, "gen 12/50  1,240/2,480 runs  23/s  best 0.000 mean 0.413  53 s left");
}

RC_GTEST_PROP(LiveProgressLine, NeverExceedsTheTerminal, ()) {
  CampaignProgress progress = Halfway();
  progress.runs_done = *rc::gen::inRange<std::uint64_t>(0, 1U << 30);
  progress.runs_planned = *rc::gen::inRange<std::uint64_t>(0, 1U << 30);
  progress.runs_failed = *rc::gen::inRange<std::uint64_t>(0, 5);
  const auto columns = *rc::gen::inRange<std::size_t>(10, 220);
  RC_ASSERT(DisplayWidth(LiveProgressLine(progress, columns)) <= columns);
}

TEST(LiveProgressLine, WithoutPlanOrGenerationsThereIsNoBar) {
  CampaignProgress progress = Halfway();
  progress.search.generations = 1;
  progress.runs_planned = 0;
  progress.remaining_seconds.reset();
  EXPECT_EQ(LiveProgressLine(progress, 160),
            "1,240 runs  23/s  best 0.000 mean 0.413  37 total failures  workers 1/2 busy");
}

TEST(PlainProgressLine, HasTheSameFactsInWords) {
  EXPECT_EQ(PlainProgressLine(Halfway()),
            "generation 12/50, runs 1,240/2,480 (23/s), best 0.000, mean 0.413, total failures 37, "
            "workers 2 (1 busy), 53 s left");
}

TEST(PlainProgressLine, NamesFailedRunsAndLostWorkersAndUnknownFitness) {
  CampaignProgress progress = Halfway();
  progress.runs_failed = 3;
  progress.workers.lost = 1;
  progress.best_fitness = progress.mean_fitness = std::numeric_limits<double>::quiet_NaN();
  progress.runs_per_second = 4.26;
  progress.remaining_seconds.reset();
  EXPECT_EQ(PlainProgressLine(progress),
            "generation 12/50, runs 1,240/2,480 (4.3/s), best -, mean -, total failures 37, RUNS FAILED 3, "
            "workers 2 (1 busy), 1 lost");
}

class Printer : public ::testing::Test {
 protected:
  ProgressPrinter Make(ProgressMode mode) {
    return {mode, clock_, [this](const std::string& text) { written_ += text; },
            [] { return std::size_t{100}; }};
  }
  int Lines() const { return static_cast<int>(std::count(written_.begin(), written_.end(), '\n')); }
  void Advance(std::chrono::milliseconds time) { clock_.Advance(time); }

  testing_support::FakeClock clock_;
  std::string written_;
};

TEST_F(Printer, PlainLinesComeAtOnceAndThenEveryFiveSeconds) {
  ProgressPrinter printer = Make(ProgressMode::kPlain);
  CampaignProgress progress = Halfway();
  printer.Update(progress);
  EXPECT_EQ(Lines(), 1);
  for (int i = 0; i < 49; ++i) {  // 4.9 s
    Advance(std::chrono::milliseconds(100));
    ++progress.runs_done;
    printer.Update(progress);
  }
  EXPECT_EQ(Lines(), 1);
  Advance(std::chrono::milliseconds(100));
  printer.Update(progress);
  EXPECT_EQ(Lines(), 2);
}

TEST_F(Printer, PlainLinesFollowGenerationsButAtMostOneASecond) {
  ProgressPrinter printer = Make(ProgressMode::kPlain);
  CampaignProgress progress = Halfway();
  printer.Update(progress);
  for (int i = 0; i < 30; ++i) {  // a generation every 0.1 s for 3 s
    Advance(std::chrono::milliseconds(100));
    ++progress.search.generation;
    printer.Update(progress);
  }
  EXPECT_EQ(Lines(), 4);
}

TEST_F(Printer, PlainEndsWithTheLastStateOnce) {
  ProgressPrinter printer = Make(ProgressMode::kPlain);
  CampaignProgress progress = Halfway();
  printer.Update(progress);
  progress.runs_done = 2480;
  printer.Update(progress);
  printer.Finish();
  printer.Finish();
  EXPECT_EQ(Lines(), 2);
  EXPECT_EQ(written_,
            "generation 12/50, runs 1,240/2,480 (23/s), best 0.000, mean 0.413, total failures 37, workers 2 "
            "(1 busy), 53 s left\n"
            "generation 12/50, runs 2,480/2,480 (23/s), best 0.000, mean 0.413, total failures 37, workers 2 "
            "(1 busy), 53 s left\n");
}

TEST_F(Printer, LiveRedrawsOneLineAndRemovesItAtTheEnd) {
  ProgressPrinter printer = Make(ProgressMode::kLive);
  printer.Update(Halfway());
  EXPECT_EQ(written_, "\r" + LiveProgressLine(Halfway(), 99) + "\x1b[K");
  written_.clear();
  printer.Update(Halfway());
  EXPECT_EQ(written_, "") << "the same line need not be drawn again";
  printer.Finish();
  EXPECT_EQ(written_, "\r\x1b[K");
}

TEST_F(Printer, NoneWritesNothing) {
  ProgressPrinter printer = Make(ProgressMode::kNone);
  printer.Update(Halfway());
  printer.Finish();
  EXPECT_EQ(written_, "");
}

TEST(ChooseProgressMode, LiveOnlyOnATerminalThatCanRedraw) {
  EXPECT_EQ(ChooseProgressMode(true, true, "xterm"), ProgressMode::kLive);
  EXPECT_EQ(ChooseProgressMode(true, true, "dumb"), ProgressMode::kPlain);
  EXPECT_EQ(ChooseProgressMode(true, true, nullptr), ProgressMode::kPlain);
  EXPECT_EQ(ChooseProgressMode(true, false, "xterm"), ProgressMode::kPlain);
  EXPECT_EQ(ChooseProgressMode(false, true, "xterm"), ProgressMode::kNone);
}

}  // namespace
}  // namespace gauntlet
