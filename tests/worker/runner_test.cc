// Parts of runners that need no process: what an exit means, the frames of the pipe.
// Covers: worker/runner/pipe.cc
#include "worker/runner/runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/socket.h>

#include <csignal>

#include "proto/run_failure.h"
#include "worker/runner/pipe.h"

namespace gauntlet::worker {

using proto::FailureKind;
using proto::RunnerFailure;

namespace {

using testing::SizeIs;

// As waitpid encodes them (wait(2)).
int Signalled(int signal) {
  return signal;
}
int Exited(int code) {
  return code << 8;
}

TEST(ClassifyExitTest, SignalsThatAProcessBringsOnItselfAreItsOwnFault) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGBUS, SIGSYS, SIGTRAP}) {
    const RunnerFailure failure = ClassifyExit(Signalled(signal), "");
    EXPECT_EQ(failure.kind, FailureKind::kCrashed) << signal;
    EXPECT_EQ(failure.signal, signal);
  }
}

TEST(ClassifyExitTest, SignalsThatOnlyOthersSendAreExternal) {
  for (const int signal : {SIGKILL, SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1}) {
    EXPECT_EQ(ClassifyExit(Signalled(signal), "").kind, FailureKind::kExternal) << signal;
  }
}

TEST(ClassifyExitTest, CpuLimitIsAHang) {
  EXPECT_EQ(ClassifyExit(Signalled(SIGXCPU), "").kind, FailureKind::kHung);
}

TEST(ClassifyExitTest, ExitsAreOwnFaultsAndOneCodeMeansMemory) {
  EXPECT_EQ(ClassifyExit(Exited(kExitOutOfMemory), "").kind, FailureKind::kOutOfMemory);
  EXPECT_EQ(ClassifyExit(Exited(kExitException), "").kind, FailureKind::kCrashed);
  EXPECT_EQ(ClassifyExit(Exited(0), "").kind, FailureKind::kCrashed) << "a run does not end its runner";
  EXPECT_EQ(ClassifyExit(Exited(3), "").exit_code, 3);
}

TEST(ClassifyExitTest, AProgramsOwnCodeIsTakenFromTheLastLine) {
  const RunnerFailure failure = ClassifyExit(Exited(kExitOfProgram), "words\n" + ExitCodeLine(86));
  EXPECT_EQ(failure.kind, FailureKind::kCrashed);
  EXPECT_EQ(failure.exit_code, 86);
  EXPECT_EQ(ClassifyExit(Exited(kExitOfProgram), ExitCodeLine(86) + "words\n").exit_code, kExitOfProgram);
  EXPECT_EQ(ClassifyExit(Exited(3), ExitCodeLine(86)).exit_code, 3);
}

TEST(ClassifyExitTest, OnlyARunnersOwnCodeSaysThatAPluginCannotBeHad) {
  EXPECT_TRUE(IsWithoutPlugin(ClassifyExit(Exited(kExitWithoutPlugin), "no such library\n")));
  EXPECT_FALSE(IsWithoutPlugin(ClassifyExit(Exited(kExitOfProgram), ExitCodeLine(kExitWithoutPlugin))));
  EXPECT_FALSE(IsWithoutPlugin(ClassifyExit(Signalled(SIGKILL), "")));
}

TEST(ClassifyExitTest, KeepsTheEndOfTheOutputAsUtf8) {
  const RunnerFailure failure = ClassifyExit(Signalled(SIGABRT), std::string(10'000, 'a') + "the end\xff");
  EXPECT_THAT(failure.stderr_tail, SizeIs(proto::kMaxStderrTail));
  EXPECT_TRUE(failure.stderr_tail.ends_with("the end?"));
}

TEST(DescribeTest, SaysWhatHappenedTheSameWayEveryTime) {
  EXPECT_EQ(Describe(ClassifyExit(Signalled(SIGSEGV), "")), "crashed with signal 11");
  EXPECT_EQ(Describe(ClassifyExit(Exited(3), "")), "crashed with exit code 3");
  EXPECT_EQ(Describe(ClassifyExit(Signalled(SIGXCPU), "noise")), "exceeded its CPU time");
  EXPECT_EQ(Describe(ClassifyExit(Exited(kExitOutOfMemory), "noise")), "exceeded its memory");
  EXPECT_EQ(Describe(ClassifyExit(Signalled(SIGKILL), "")), "was ended from outside by signal 9");
}

RC_GTEST_PROP(RunnerProtocolProperty, JobsAndReportsComeBackAsTheyWere,
              (const std::string& bytes, std::uint64_t memory, std::uint16_t cpu)) {
  const auto job = DecodeJob(EncodeJob({bytes, cpu / 8.0, memory, 7, memory % 2 == 0}));
  RC_ASSERT(job.has_value());
  RC_ASSERT(job->spec == bytes);
  RC_ASSERT(job->cpu_limit_seconds == cpu / 8.0);
  RC_ASSERT(job->memory_limit_bytes == memory);
  RC_ASSERT(job->max_result_bytes == 7u);
  RC_ASSERT(job->without_ways == (memory % 2 == 0));
  const auto report = DecodeReport(EncodeReport({bytes, 0.5, cpu / 8.0}));
  RC_ASSERT(report.has_value());
  RC_ASSERT(report->result == bytes);
  RC_ASSERT(report->process_cpu_seconds == cpu / 8.0);
  RC_ASSERT(!DecodeReport(EncodeReport({bytes, 0.5, 0.5}) + "x").has_value());
}

RC_GTEST_PROP(FrameBufferProperty, FramesArriveWholeHoweverTheyAreCut,
              (const std::vector<std::string>& payloads)) {
  SocketPair pair = std::move(MakeSocketPair(SOCK_STREAM)).value();
  std::string stream;
  for (const std::string& payload : payloads) stream += MakeFrame(payload);
  FrameBuffer buffer;
  std::vector<std::string> received;
  for (std::size_t position = 0; position < stream.size();) {
    const std::size_t size =
        std::min<std::size_t>(*rc::gen::inRange<std::size_t>(1, 50), stream.size() - position);
    RC_ASSERT(send(pair.first.get(), stream.data() + position, size, 0) == static_cast<ssize_t>(size));
    position += size;
    RC_ASSERT(buffer.ReadFrom(pair.second.get()) == FrameBuffer::State::kOpen);
    while (auto frame = buffer.Next()) received.push_back(std::move(*frame));
  }
  RC_ASSERT(received == payloads);
}

TEST(FrameBufferTest, EndOfTheStreamIsReportedAfterTheLastFrame) {
  SocketPair pair = std::move(MakeSocketPair(SOCK_STREAM)).value();
  ASSERT_TRUE(WriteFrame(pair.first.get(), "last"));
  pair.first.Reset();
  FrameBuffer buffer;
  while (buffer.ReadFrom(pair.second.get()) == FrameBuffer::State::kOpen) continue;
  EXPECT_EQ(buffer.Next(), "last");
  EXPECT_EQ(buffer.Next(), std::nullopt);
}

TEST(FrameBufferTest, AnAbsurdLengthIsDamage) {
  SocketPair pair = std::move(MakeSocketPair(SOCK_STREAM)).value();
  ASSERT_EQ(send(pair.first.get(), "\xff\xff\xff\xffxxxx", 8, 0), 8);
  EXPECT_EQ(FrameBuffer().ReadFrom(pair.second.get(), FrameBuffer::Wait::kYes), FrameBuffer::State::kDamaged);
}

}  // namespace
}  // namespace gauntlet::worker
