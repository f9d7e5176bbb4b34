#include "study/streams/evaluation_pipe.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "base/system/unique_fd.h"
#include "master/session/search_loop.h"
#include "search/search_table.h"
#include "tests/study/questions/answering.h"
#include "tests/support/fake_backend.h"
#include "tests/support/fake_clock.h"

namespace gauntlet {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::SizeIs;
using testing_support::Ended;
using testing_support::FakeBackend;
using testing_support::FakeClock;
using testing_support::MemoryStore;

std::string LineOf(const std::string& id, double x) {
  return json{{"id", id}, {"case", {{"obstacles", {{{"x", x}, {"length", 1}, {"width", 0.2}}}}}}}.dump() +
         "\n";
}

// A program at the other ends of both pipes, and one life of the master between them.
class PipeSession {
 public:
  explicit PipeSession(MemoryStore& store, const std::vector<std::string>& sets = {})
      : experiment_(testing_support::Flocking([&] {
          std::vector<std::string> all = sets;
          all.emplace_back("search.algorithm=stream");
          return all;
        }())),
        backend(clock_, Simulate),
        store_(store) {
    MakePipe(their_out_, in_);
    MakePipe(out_, their_in_);
    if (store.searches.empty()) store.searches.push_back({1, "flocking", "stream", experiment_.seed});
    search_ = MakeSearch(experiment_).value();
    pipe.emplace(experiment_, "dir", EvaluationPipe::Descriptors{in_.get(), out_.get()});
    plan_ = {"", experiment_, {}, 1};
    driver_.emplace(SearchDriver::Parts{
        .plan = plan_, .search = *search_, .backend = backend, .store = store_, .feed = &*pipe});
    loop_.emplace(SearchLoop::Parts{{&*driver_}, backend, store_, clock_, &*pipe});
    EXPECT_TRUE(loop_->Restore().ok());
    EXPECT_TRUE(pipe->Begin(1, *search_->Stream(), store_).ok());
  }

  void Write(const std::string& text) {
    ASSERT_EQ(write(their_out_.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void End() { their_out_.Reset(); }
  void StopReading() { their_in_.Reset(); }
  // Until the input has ended, or `most` steps of it.
  Result<CampaignEnd> Run(int most = 100000) {
    return loop_->Run([&] { return most-- > 0 ? StopWish::kNone : StopWish::kNow; }, [](const auto&) {});
  }
  // What has come since, the greeting left out.
  std::vector<json> Answers() {
    std::string text;
    std::array<char, 4096> bytes;
    for (ssize_t size = 0; (size = read(their_in_.get(), bytes.data(), bytes.size())) > 0;)
      text.append(bytes.data(), static_cast<std::size_t>(size));
    std::vector<json> answers;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) answers.push_back(json::parse(line));
    std::erase_if(answers, [](const json& one) { return one.contains("protocol"); });
    return answers;
  }

  std::optional<EvaluationPipe> pipe;

 private:
  static sim::RunResult Simulate(const sim::RunSpec& spec) {
    sim::RunResult result =
        Ended(false, spec.test_case.obstacles.empty() ? 1.0 : spec.test_case.obstacles[0].x);
    result.metrics.emplace_back("seed", static_cast<double>(spec.seed >> 32));
    return result;
  }
  // Theirs never blocks the test.
  static void MakePipe(UniqueFd& write_end, UniqueFd& read_end) {
    int ends[2];
    ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
    read_end.Reset(ends[0]);
    write_end.Reset(ends[1]);
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
  }

  UniqueFd in_, out_, their_in_, their_out_;
  FakeClock clock_;
  Experiment experiment_;
  SearchPlan plan_;
  std::unique_ptr<SearchAlgorithm> search_;

 public:
  FakeBackend backend;

 private:
  MemoryStore& store_;
  std::optional<SearchDriver> driver_;
  std::optional<SearchLoop> loop_;
};

TEST(EvaluationPipeTest, GreetsAndAnswersEachLine) {
  MemoryStore store;
  PipeSession session(store);
  session.Write(LineOf("a", 0.5) + "\n \r\n" + LineOf("b", 0.25));
  session.End();
  EXPECT_EQ(session.Run().value(), CampaignEnd::kFinished);
  const auto answers = session.Answers();
  ASSERT_THAT(answers, SizeIs(2)) << "empty lines say nothing";
  EXPECT_EQ(answers[0]["id"], "a");
  EXPECT_EQ(answers[1]["fitness"], 0.25);
  EXPECT_EQ(answers[1]["line"], 2);
  EXPECT_EQ(answers[1]["individual"], 2);
  EXPECT_THAT(store.individuals[1], SizeIs(2));
  EXPECT_THAT(store.states[1], SizeIs(1)) << "of the end";
  EXPECT_EQ(store.LoadSearches().value()[0].finished_with, store.LoadSearches().value()[0].last_run);
}

TEST(EvaluationPipeTest, AnswersInTheOrderOfFinishing) {
  MemoryStore store;
  PipeSession session(store);
  session.backend.next = [](std::size_t running) { return running - 1; };
  session.Write(LineOf("a", 0.1) + LineOf("b", 0.2) + LineOf("c", 0.3));
  session.End();
  ASSERT_TRUE(session.Run().ok());
  const auto answers = session.Answers();
  ASSERT_THAT(answers, SizeIs(3));
  EXPECT_EQ(answers[0]["id"], "c");
}

TEST(EvaluationPipeTest, ABadLineIsAnsweredAndTheNextGoesOn) {
  MemoryStore store;
  PipeSession session(store);
  session.Write("{\"id\": \"x\", \"cas\": {}}\n" + LineOf("a", 0.1) + "{\"id\": \"half\"");
  session.End();
  ASSERT_TRUE(session.Run().ok());
  const auto answers = session.Answers();
  ASSERT_THAT(answers, SizeIs(3));
  EXPECT_EQ(answers[0]["id"], "x");
  EXPECT_THAT(answers[0]["error"], HasSubstr("case"));
  EXPECT_EQ(answers[1]["line"], 3) << "the line without an end, at once";
  EXPECT_EQ(answers[2]["individual"], 1) << "only good lines get a number";
}

TEST(EvaluationPipeTest, ALineWithoutEndCostsNoMemory) {
  MemoryStore store;
  PipeSession session(store);
  const std::string part(50'000, ' ');
  for (int i = 0; i < 100; ++i) {
    session.Write(part);
    ASSERT_TRUE(session.pipe->Turn(64).ok());
  }
  session.Write("\n" + LineOf("a", 0.1));
  session.End();
  ASSERT_TRUE(session.Run().ok());
  const auto answers = session.Answers();
  ASSERT_THAT(answers, SizeIs(2));
  EXPECT_THAT(answers[0]["error"], HasSubstr("longer than 1048576 bytes"));
  EXPECT_EQ(answers[1]["id"], "a");
}

TEST(EvaluationPipeTest, TheSameLineAgainIsAnsweredWithoutARun) {
  MemoryStore store;
  PipeSession session(store);
  session.Write(LineOf("a", 0.1) + LineOf("a", 0.1));  // the first is not answered yet
  ASSERT_TRUE(session.Run(5).ok());
  session.Write(LineOf("a", 0.1) + LineOf("a", 0.2));
  session.End();
  ASSERT_TRUE(session.Run().ok());
  auto answers = session.Answers();
  ASSERT_THAT(answers, SizeIs(4));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(answers[i]["line"], i + 1);
    answers[i].erase("line");
    EXPECT_EQ(answers[i], answers[0]);
  }
  EXPECT_THAT(answers[3]["error"], HasSubstr("given before, to individual 1, with other content"));
  EXPECT_THAT(store.runs, SizeIs(1));
}

TEST(EvaluationPipeTest, WithoutAnIdTheSameCaseIsAnotherIndividualWithTheSameSeeds) {
  MemoryStore store;
  PipeSession session(store);
  session.Write(
      "{\"case\": {}}\n{\"case\": {}, \"set\": {\"physics\": \"box2d\"}}\n{\"case\": {}, \"seed\": 5}\n");
  session.End();
  ASSERT_TRUE(session.Run().ok());
  const auto answers = session.Answers();
  ASSERT_THAT(answers, SizeIs(3));
  EXPECT_NE(answers[0]["individual"], answers[1]["individual"]);
  EXPECT_EQ(answers[0]["runs"][0]["seed"], answers[1]["runs"][0]["seed"]);
  EXPECT_NE(answers[0]["runs"][0]["seed"], answers[2]["runs"][0]["seed"]);
}

// Whatever the moment at which a master dies: what was answered is answered the same, and in the end the
// store holds what it would hold without an accident.
TEST(EvaluationPipeTest, AMasterThatIsKilledLosesNoAnswer) {
  std::string lines;
  for (int i = 0; i < 12; ++i) lines += LineOf(std::to_string(i), 0.05 * i);
  const auto by_id = [](const std::vector<json>& answers) {
    std::map<std::string, json> all;
    for (json one : answers) {
      one.erase("line");
      all[one["id"]] = one;
    }
    return all;
  };
  MemoryStore undisturbed;
  PipeSession whole(undisturbed);
  whole.Write(lines);
  whole.End();
  ASSERT_TRUE(whole.Run().ok());
  const auto expected = by_id(whole.Answers());
  ASSERT_THAT(expected, SizeIs(12));

  for (int steps = 1; steps < 12; ++steps) {
    MemoryStore store;
    {
      PipeSession killed(store);
      killed.backend.next = [](std::size_t running) { return running / 2; };
      killed.Write(lines);
      ASSERT_TRUE(killed.Run(steps).ok());
      for (const auto& [id, answer] : by_id(killed.Answers())) EXPECT_EQ(answer, expected.at(id));
      store.Crash();
    }
    PipeSession next(store);
    next.Write(lines);
    next.End();
    ASSERT_TRUE(next.Run().ok());
    EXPECT_EQ(by_id(next.Answers()), expected) << steps;
    EXPECT_THAT(store.runs, SizeIs(12));
    for (const auto& [id, run] : undisturbed.runs) EXPECT_EQ(store.runs.at(id).hash, run.hash);
  }
}

// Only what a client has asked for in this session is answered.
TEST(EvaluationPipeTest, WhatNobodyAsksForAgainIsSimulatedAndNotTold) {
  MemoryStore store;
  {
    PipeSession killed(store);
    killed.Write(LineOf("a", 0.1) + LineOf("b", 0.2));
    ASSERT_TRUE(killed.Run(2).ok());
    store.CommitAll();
  }
  PipeSession next(store);
  next.Write(LineOf("c", 0.3));
  next.End();
  ASSERT_TRUE(next.Run().ok());
  const auto answers = next.Answers();
  ASSERT_THAT(answers, SizeIs(1));
  EXPECT_EQ(answers[0]["individual"], 3);
  EXPECT_THAT(store.runs, SizeIs(3));
}

TEST(EvaluationPipeTest, ReadsNoMoreThanTheWindowAhead) {
  MemoryStore store;
  PipeSession session(store);
  for (int i = 0; i < 100; ++i) session.Write(LineOf(std::to_string(i), 0.1));
  ASSERT_TRUE(session.pipe->Turn(64).ok());
  EXPECT_EQ(session.pipe->lines(), 64U);
  EXPECT_EQ(session.pipe->fd(), -1) << "waiting for more would be for nothing";
  ASSERT_TRUE(session.pipe->Turn(65).ok());
  EXPECT_EQ(session.pipe->lines(), 65U);
}

TEST(EvaluationPipeTest, TheSameLineForEverFillsTheWindowToo) {
  MemoryStore store;
  PipeSession session(store);
  for (int i = 0; i < 100; ++i) session.Write(LineOf("a", 0.1));
  ASSERT_TRUE(session.pipe->Turn(64).ok());
  EXPECT_EQ(session.pipe->lines(), 64U);
}

// A pipe holds 64 KiB, what waits for it at most a megabyte and what was on its way.
TEST(EvaluationPipeTest, AClientThatNeverReadsIsNotReadFromForEver) {
  MemoryStore store;
  PipeSession session(store);
  const std::string bad(900, 'x');
  std::uint64_t lines = 0;
  for (int i = 0; i < 3000; ++i) {
    session.Write("{\"" + bad + "\": 1}\n");
    ASSERT_TRUE(session.pipe->Turn(64).ok());
    if (session.pipe->lines() == lines) break;
    lines = session.pipe->lines();
  }
  EXPECT_LT(lines, 2000U);
  EXPECT_FALSE(session.pipe->Drained());
  EXPECT_LE(session.pipe->patience(), std::chrono::milliseconds(10));
}

TEST(EvaluationPipeTest, WhenNobodyReadsTheAnswersItSaysSo) {
  signal(SIGPIPE, SIG_IGN);
  MemoryStore store;
  PipeSession session(store);
  session.StopReading();
  session.Write(LineOf("a", 0.1));
  const auto end = session.Run();
  ASSERT_FALSE(end.ok());
  EXPECT_THAT(end.error().message, HasSubstr("nobody reads the answers"));
}

TEST(EvaluationPipeTest, WaitsForInputWithoutSpinning) {
  MemoryStore store;
  PipeSession session(store);
  ASSERT_TRUE(session.pipe->Turn(64).ok());
  EXPECT_GE(session.pipe->fd(), 0);
  EXPECT_GE(session.pipe->patience(), std::chrono::milliseconds(100));
}

}  // namespace
}  // namespace gauntlet
