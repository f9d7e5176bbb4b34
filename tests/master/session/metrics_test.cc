#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <list>
#include <set>
#include <sstream>

#include "master/session/metrics_server.h"
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
  const std::string text = MetricsText(master, progress, backend, {1.5, 4096});
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
  std::istringstream lines(MetricsText({}, {}, {}, {}));
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

class MetricsServerTest : public testing::Test {
 protected:
  std::string Ask(const std::string& request) { return Converse(server_->port(), request); }

  std::unique_ptr<MetricsServer> server_ = *MetricsServer::Start(0);
};

TEST_F(MetricsServerTest, AnswersWithWhatWasPublishedLast) {
  EXPECT_THAT(Ask("GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n"), StartsWith("HTTP/1.1 503 "));
  server_->Publish("first 1\n");
  server_->Publish("second 2\n");
  EXPECT_THAT(Ask("GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n"),
              AllOf(StartsWith("HTTP/1.1 200 OK\r\nContent-Type: text/plain; version=0.0.4"),
                    HasSubstr("Content-Length: 9\r\n"), HasSubstr("\r\n\r\nsecond 2\n")));
  EXPECT_EQ(server_->url(), "http://127.0.0.1:" + std::to_string(server_->port()) + "/metrics");
}

TEST_F(MetricsServerTest, AnythingElseIsRefused) {
  server_->Publish("secret 1\n");
  EXPECT_THAT(Ask("GET /etc/passwd HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(Ask("GET /metrics/../x HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(Ask("POST /metrics HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 405 "));
  EXPECT_THAT(Ask(std::string(100'000, 'x')), testing::Not(HasSubstr("secret")));
  // Half a request is waited for a second, and then dropped; the next is answered.
  EXPECT_EQ(Ask("GET /metr"), "");
  EXPECT_THAT(Ask("GET /metrics HTTP/1.0\r\n\r\n"), HasSubstr("secret 1\n"));
}

// A scraper gives up after ten seconds; whoever has it wait for strangers that say nothing needs their number
// of seconds.
TEST_F(MetricsServerTest, IdleConnectionsKeepNobodyWaiting) {
  server_->Publish("fresh 1\n");
  for (const std::size_t strangers : {200UL, 3 * MetricsServer::kMostConnections}) {
    std::list<testing_support::OpenConnection> idle;
    for (std::size_t i = 0; i < strangers; ++i)
      ASSERT_TRUE(idle.emplace_back(server_->port(), i % 2 == 0 ? "GET /me" : "").ok()) << i;
    const auto asked = std::chrono::steady_clock::now();
    EXPECT_THAT(Ask("GET /metrics HTTP/1.1\r\n\r\n"), HasSubstr("fresh 1\n"));
    EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(5)) << strangers;
  }
}

TEST_F(MetricsServerTest, AnAnswerLongerThanTheSocketTakesArrivesWhole) {
  const std::string text(8 << 20, 'x');
  server_->Publish(text);
  const std::string answer = Ask("GET /metrics HTTP/1.1\r\n\r\n");
  EXPECT_EQ(answer.size() - answer.find("\r\n\r\n") - 4, text.size());
}

TEST_F(MetricsServerTest, APortThatIsTakenIsNamed) {
  const Result<std::unique_ptr<MetricsServer>> second = MetricsServer::Start(server_->port());
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().kind, ErrorKind::kInUse);
  EXPECT_EQ(second.error().message, "cannot serve metrics on 127.0.0.1:" + std::to_string(server_->port()) +
                                        ": Address already in use");
}

}  // namespace
}  // namespace gauntlet
