#include "slurm/job_status.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet::slurm {
namespace {

using testing::HasSubstr;

TEST(ParseQueue, ReadsWhatSqueuePrints) {
  const Result<std::vector<JobStatus>> jobs = ParseQueue(
      "12|RUNNING|node3|None|gauntlet-ab12-w1\n"
      "13_4|PENDING||Resources|gauntlet-ab12-w2\n"
      "14|NODE_FAIL|node1|NodeDown|a name|with a bar\n");
  ASSERT_TRUE(jobs.ok());
  ASSERT_EQ(jobs->size(), 3U);
  EXPECT_EQ((*jobs)[0].id, "12");
  EXPECT_EQ((*jobs)[0].phase, JobPhase::kRunning);
  EXPECT_EQ((*jobs)[0].nodes, "node3");
  EXPECT_EQ((*jobs)[0].reason, "") << "None is Slurm's word for nothing";
  EXPECT_EQ((*jobs)[1].id, "13_4");
  EXPECT_EQ((*jobs)[1].phase, JobPhase::kQueued);
  EXPECT_EQ((*jobs)[1].reason, "Resources");
  EXPECT_EQ((*jobs)[2].phase, JobPhase::kEnded);
  EXPECT_EQ((*jobs)[2].name, "a name|with a bar");
}

TEST(ParseQueue, AnEmptyQueueIsNoError) {
  const Result<std::vector<JobStatus>> jobs = ParseQueue("\n");
  ASSERT_TRUE(jobs.ok());
  EXPECT_TRUE(jobs->empty());
}

TEST(ParseQueue, QuotesWhatIsNoQueue) {
  const Result<std::vector<JobStatus>> jobs = ParseQueue("squeue: strange news\n");
  ASSERT_FALSE(jobs.ok());
  EXPECT_EQ(jobs.error().message,
            "squeue printed 'squeue: strange news', which is not of the form id|state|node|reason|name");
}

TEST(PhaseOf, AnUnknownWordIsNotAnEnd) {
  EXPECT_EQ(PhaseOf("HIBERNATING"), JobPhase::kUnknown);
  EXPECT_EQ(PhaseOf("COMPLETING"), JobPhase::kEnding);
  EXPECT_EQ(PhaseOf("OUT_OF_MEMORY"), JobPhase::kEnded);
  EXPECT_EQ(PhaseOf("SUSPENDED"), JobPhase::kRunning);
}

TEST(ParseJobId, TakesBothForms) {
  EXPECT_EQ(*ParseJobId("123\n"), "123");
  EXPECT_EQ(*ParseJobId("123;cluster\n"), "123");
  for (const char* text : {"", "\n", "Submitted batch job 12", "-1", ";x"})
    EXPECT_FALSE(ParseJobId(text).ok()) << text;
}

TEST(ParseTimeLimit, TakesSbatchsForms) {
  EXPECT_EQ(*ParseTimeLimit("30"), 30 * 60);
  EXPECT_EQ(*ParseTimeLimit("10:30"), 10 * 60 + 30);
  EXPECT_EQ(*ParseTimeLimit("02:00:05"), 2 * 3600 + 5);
  EXPECT_EQ(*ParseTimeLimit("1-12"), 36 * 3600);
  EXPECT_EQ(*ParseTimeLimit("1-00:30"), 24 * 3600 + 30 * 60);
  for (const char* text : {"", "0", "2h", "1:2:3:4", "-5", "1-", "99999999999"}) {
    const Result<long> limit = ParseTimeLimit(text);
    ASSERT_FALSE(limit.ok()) << text;
    EXPECT_THAT(limit.error().message, HasSubstr("02:00:00"));
  }
}

}  // namespace
}  // namespace gauntlet::slurm
