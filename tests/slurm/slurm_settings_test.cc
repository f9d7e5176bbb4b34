#include "slurm/slurm_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet::slurm {
namespace {

using testing::ElementsAre;

TEST(ReadSlurmSettings, LaterSourcesWin) {
  const Result<SlurmSettings> settings = ReadSlurmSettings(
      {{"account = \"mine\"\npartition = \"long\"\n", "slurm.toml", true},
       {"seed = 3\n[slurm]\npartition = \"short\"\nmax_allocations = 2\n", "e.toml", false}},
      {"max_allocations=5", "extra=--exclusive --comment=a b", "time_limit=30"});
  ASSERT_TRUE(settings.ok()) << settings.error().message;
  EXPECT_EQ(settings->worker_job.account, "mine");
  EXPECT_EQ(settings->worker_job.partition, "short");
  EXPECT_EQ(settings->pool.max_allocations, 5);
  EXPECT_EQ(settings->worker_job.time_limit, "30");
  EXPECT_THAT(settings->worker_job.extra, ElementsAre("--exclusive", "--comment=a b"));
}

TEST(ReadSlurmSettings, NamesPlaceKeyAndWhatIsAllowed) {
  const auto error_of = [](const std::string& set) {
    const Result<SlurmSettings> settings = ReadSlurmSettings({}, {set});
    return settings.ok() ? "" : settings.error().message;
  };
  EXPECT_EQ(error_of("partitoin=main"),
            "--slurm partitoin=main: unknown Slurm setting 'partitoin'; did you mean 'partition'?");
  EXPECT_EQ(error_of("max_queued=0"),
            "--slurm max_queued=0: max_queued = 0 is out of range, allowed 1 to 1000");
  EXPECT_EQ(error_of("master=there"),
            "--slurm master=there: master = \"there\" is unknown, allowed job, here");
  EXPECT_EQ(error_of("time_limit=2h"),
            "--slurm time_limit=2h: time_limit: time limit '2h': give minutes (30), hours:minutes:seconds "
            "(02:00:00) or days-hours:minutes:seconds");
  const Result<SlurmSettings> settings = ReadSlurmSettings({{"\nqos = true\n", "s.toml", true}}, {});
  ASSERT_FALSE(settings.ok());
  EXPECT_EQ(settings.error().message, "s.toml:2:1: qos is true or false, expected text");
}

TEST(WriteSlurmSettings, ReadsBackEqual) {
  const Result<SlurmSettings> settings =
      ReadSlurmSettings({}, {"setup=module load \"x\"\nexport A=1", "workers_per_allocation=16",
                             "idle_timeout=7", "extra=--exclusive -A b", "worker_command=/opt/a b"});
  ASSERT_TRUE(settings.ok()) << settings.error().message;
  const std::string text = WriteSlurmSettings(*settings);
  const Result<SlurmSettings> again = ReadSlurmSettings({{text, "slurm.toml", true}}, {});
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(WriteSlurmSettings(*again), text);
  EXPECT_EQ(again->worker_job.setup, "module load \"x\"\nexport A=1");
  EXPECT_THAT(again->worker_job.extra, ElementsAre("--exclusive", "-A b"));
  EXPECT_EQ(again->pool.idle_timeout, std::chrono::seconds(7));
}

}  // namespace
}  // namespace gauntlet::slurm
