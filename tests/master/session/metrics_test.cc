// Covers: master/session/metrics_page.cc, master/session/metrics_text.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

#include "master/session/metrics_page.h"
#include "master/session/metrics_text.h"
#include "tests/support/local_socket.h"

namespace gauntlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing_support::Converse;

TEST(MetricsText, NamesWhatRunsAndWhatWasLost) {
  MasterView master;
  master.campaign_id = "c1";
  master.experiment = "with \"quotes\" and \\ and\nlines";
  master.host = "node1";
  master.epoch = 3;
  CampaignProgress progress;
  progress.runs_done = 812;
  progress.best_fitness = std::nan("");
  progress.workers.releases = 2;
  BackendView backend;
  backend.queued = 7;
  backend.workers.resize(3);
  backend.workers[0].leases.resize(2);
  backend.workers[1].lost = true;
  const std::string text = MetricsText(StatusMetrics(master, progress, backend), {1.5, 4096});
  EXPECT_THAT(text,
              HasSubstr("gauntlet_campaign_info{campaign=\"c1\",experiment=\"with \\\"quotes\\\" and \\\\ "
                        "and\\nlines\",host=\"node1\",epoch=\"3\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("# TYPE gauntlet_runs_stored_total counter\ngauntlet_runs_stored_total 812\n"));
  EXPECT_THAT(text, HasSubstr("gauntlet_workers{state=\"running\"} 1\ngauntlet_workers{state=\"idle\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("gauntlet_workers{state=\"lost\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("\ngauntlet_runs_leased 2\n"));
  EXPECT_THAT(text, HasSubstr("\ngauntlet_runs_queued 7\n"));
  EXPECT_THAT(text, HasSubstr("\ngauntlet_best_fitness NaN\n"));
  EXPECT_THAT(text, HasSubstr("\ngauntlet_runs_leased_again_total 2\n"));
  EXPECT_THAT(text, HasSubstr("\nprocess_resident_memory_bytes 4096\n"));
}

// What a parser of the format demands: every sample has a type before it, no metric is described twice.
TEST(MetricsText, EverySampleIsDescribedOnce) {
  std::istringstream lines(MetricsText(StatusMetrics({}, {}, {}), {}));
  std::set<std::string> described;
  int samples = 0;
  for (std::string line; std::getline(lines, line);) {
    ASSERT_FALSE(line.empty());
    if (line.starts_with("# TYPE ")) {
      EXPECT_TRUE(described.insert(line.substr(7, line.find(' ', 7) - 7)).second) << line;
    } else if (!line.starts_with("#")) {
      ++samples;
      EXPECT_TRUE(described.contains(line.substr(0, line.find_first_of("{ ")))) << line;
    }
  }
  EXPECT_GT(samples, 15);
}

TEST(MetricsText, AProcessKnowsItsCost) {
  const ProcessCost cost = CostOfThisProcess();
  EXPECT_GT(cost.resident_bytes, 1U << 20);
  EXPECT_GT(cost.cpu_seconds, 0.0);
}

class MetricsPageTest : public testing::Test {
 protected:
  std::string Ask(const std::string& request) { return Converse(Port(), request); }
  int Port() const {
    const std::string url = page_->url();
    return std::stoi(url.substr(url.rfind(':') + 1));
  }

  std::unique_ptr<MetricsPage> page_ = *MetricsPage::Serve(0);
};

TEST_F(MetricsPageTest, AnswersWithWhatWasPublishedLast) {
  EXPECT_THAT(Ask("GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n"), StartsWith("HTTP/1.1 503 "));
  page_->Publish("first 1\n");
  page_->Publish("second 2\n");
  EXPECT_THAT(Ask("GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n"),
              AllOf(StartsWith("HTTP/1.1 200 OK\r\nContent-Type: text/plain; version=0.0.4"),
                    HasSubstr("Content-Length: 9\r\n"), HasSubstr("\r\n\r\nsecond 2\n")));
  EXPECT_THAT(Ask("GET /metrics?all HTTP/1.0\r\n\r\n"), HasSubstr("second 2\n"));
  EXPECT_THAT(page_->url(), testing::MatchesRegex("http://127\\.0\\.0\\.1:[0-9]+/metrics"));
}

TEST_F(MetricsPageTest, AnythingElseIsRefused) {
  page_->Publish("secret 1\n");
  EXPECT_THAT(Ask("GET /etc/passwd HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(Ask("GET /metrics/../x HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(Ask("POST /metrics HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 405 "));
}

TEST_F(MetricsPageTest, APortThatIsTakenIsNamed) {
  const Result<std::unique_ptr<MetricsPage>> second = MetricsPage::Serve(Port());
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().kind, ErrorKind::kInUse);
  EXPECT_EQ(second.error().message,
            "cannot serve metrics on 127.0.0.1:" + std::to_string(Port()) + ": Address already in use");
}

}  // namespace
}  // namespace gauntlet
