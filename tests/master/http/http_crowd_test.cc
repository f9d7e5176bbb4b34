// Many who want nothing, or want it slowly, and one who wants an answer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <future>
#include <iterator>
#include <latch>
#include <list>
#include <thread>
#include <vector>

#include "base/system/unique_fd.h"
#include "master/http/http_server.h"
#include "tests/support/local_socket.h"
#include "tests/support/sanitizer.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using testing::EndsWith;
using testing_support::Converse;
using testing_support::OpenConnection;

using Clock = std::chrono::steady_clock;

constexpr milliseconds kPatience{10'000};
constexpr milliseconds kSoon{100};
const std::string kWhole = "GET / HTTP/1.1\r\nHost: here\r\n\r\n";
const std::string kEndlessBody = "POST / HTTP/1.1\r\nContent-Length: 10000\r\n\r\n";

HttpAnswer Fine(const HttpRequest&) {
  return {.body = "fine"};
}

// More than sockets take without a reader.
HttpAnswer Vast(const HttpRequest&) {
  return {.body = std::string(16 << 20, 'x')};
}

// The same answers, of which each counts.
HttpHandler Told(std::latch& asked, HttpHandler answer) {
  return [&asked, answer = std::move(answer)](const HttpRequest& request) {
    asked.count_down();
    return answer(request);
  };
}

std::ptrdiff_t OpenDescriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

bool DescriptorsBecome(std::ptrdiff_t count) {
  const auto end = Clock::now() + kPatience;
  while (OpenDescriptors() != count && Clock::now() < end) std::this_thread::yield();
  return OpenDescriptors() == count;
}

milliseconds Since(Clock::time_point begin) {
  return std::chrono::duration_cast<milliseconds>(Clock::now() - begin);
}

class HttpCrowdTest : public testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    rlimit limit{};
    getrlimit(RLIMIT_NOFILE, &limit);
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 4096);
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
  }
  std::unique_ptr<HttpServer> Start(HttpOptions options, HttpHandler answer) {
    options.answering_threads = GetParam();
    return *HttpServer::Start(std::move(options), std::move(answer));
  }
};

// On the thread of the sockets, as metrics are answered, and on others, as pages are.
INSTANTIATE_TEST_SUITE_P(AnsweringThreads, HttpCrowdTest, testing::Values(0, 4));

TEST_P(HttpCrowdTest, WhoAsksSlowlyIsCutOff) {
  const auto server = Start({.asking_time = kSoon}, Fine);
  for (const std::string& begin : {std::string(), std::string("GET /slow"), kEndlessBody}) {
    OpenConnection slow(server->port(), begin);
    const auto since = Clock::now();
    EXPECT_TRUE(slow.IsClosedWhileSaying('x', kPatience)) << begin;
    EXPECT_GE(Since(since) + milliseconds(10), kSoon) << begin;
  }
  EXPECT_EQ(Converse(server->port(), "GET /half"), "");
}

TEST_P(HttpCrowdTest, WhoStaysAfterItsAnswerIsCutOff) {
  std::latch asked(2);
  const auto server = Start({.asking_time = kSoon}, Told(asked, Fine));
  const std::ptrdiff_t before = OpenDescriptors();
  const OpenConnection silent(server->port(), kWhole);
  OpenConnection talker(server->port(), kWhole);
  asked.wait();
  const auto end = Clock::now() + kPatience;
  while (OpenDescriptors() != before + 2 && Clock::now() < end)
    talker.IsClosedWhileSaying('x', milliseconds(1));
  EXPECT_EQ(OpenDescriptors(), before + 2) << "the server's ends are closed";
}

TEST_P(HttpCrowdTest, WhoDoesNotTakeItsAnswerIsCutOff) {
  std::latch asked(1);
  const auto server = Start({.standstill_time = kSoon}, Told(asked, Vast));
  const std::ptrdiff_t before = OpenDescriptors();
  const OpenConnection silent(server->port(), kWhole);
  asked.wait();
  EXPECT_TRUE(DescriptorsBecome(before + 1)) << "the server's end is closed";
}

TEST_P(HttpCrowdTest, TheOldestThatHasNotAskedMakesRoom) {
  const auto server = Start({.most_connections = 8, .asking_time = kPatience}, Fine);
  std::list<OpenConnection> idle;
  for (int i = 0; i < 8; ++i) idle.emplace_back(server->port(), "GET /");
  EXPECT_THAT(Converse(server->port(), kWhole), EndsWith("fine"));
  EXPECT_TRUE(idle.front().IsClosedWhileSaying('x', kPatience));
  EXPECT_FALSE(idle.back().IsClosedWhileSaying('x', kSoon));
}

// Slow ones and idle ones, who come again as they are cut off.
TEST_P(HttpCrowdTest, AFloodKeepsTheOwnerFromNothing) {
  const auto server = Start({}, Fine);
  const auto come = [&](std::list<OpenConnection>& crowd) {
    for (int i = 0; i < 40; ++i) crowd.emplace_back(server->port(), i % 2 == 0 ? "GET /slow" : kEndlessBody);
    for (int i = 0; i < 1000; ++i) crowd.emplace_back(server->port(), "");
  };
  std::list<OpenConnection> standing;
  come(standing);
  std::atomic<bool> over = false;
  std::thread flood([&] {
    while (!over) {
      std::list<OpenConnection> coming;
      come(coming);
      for (OpenConnection& one : coming) one.IsClosedWhileSaying('x', milliseconds(0));
    }
  });
  std::vector<milliseconds> waited;
  for (int i = 0; i < 501; ++i) {
    const auto asked = Clock::now();
    // Whoever is so slow to ask that 128 others come first asks again.
    while (!Converse(server->port(), kWhole).ends_with("fine"))
      if (Since(asked) > kPatience) break;
    waited.push_back(Since(asked));
  }
  over = true;
  flood.join();
  std::ranges::sort(waited);
  RecordProperty("median_ms", static_cast<int>(waited[waited.size() / 2].count()));
  RecordProperty("longest_ms", static_cast<int>(waited.back().count()));
  EXPECT_LT(waited[waited.size() / 2], kSoon);
}

// Those that wait are announced over and over.
TEST_P(HttpCrowdTest, WhoComesWhileThereAreNoDescriptorsIsServedLater) {
  if (testing_support::kSanitized) GTEST_SKIP() << "sanitizers read memory through pipes";
  const auto server = Start({}, Fine);
  std::vector<UniqueFd> all;
  do {
    all.emplace_back(dup(STDERR_FILENO));
  } while (all.back().valid());
  all.resize(all.size() - 2);
  auto answer = std::async(std::launch::async, Converse, server->port(), kWhole);
  EXPECT_EQ(answer.wait_for(kSoon), std::future_status::timeout);
  all.clear();
  EXPECT_THAT(answer.get(), EndsWith("fine"));
}

TEST_P(HttpCrowdTest, ItStopsAtOnceHoweverBusyItIs) {
  auto server = Start({.asking_time = kPatience, .standstill_time = kPatience}, Vast);
  const std::ptrdiff_t before = OpenDescriptors();
  std::list<OpenConnection> crowd;
  for (int i = 0; i < 8; ++i) {
    for (const std::string& begin : {std::string(), std::string("GET /slow"), kEndlessBody, kWhole})
      crowd.emplace_back(server->port(), begin);
  }
  ASSERT_TRUE(DescriptorsBecome(before + 64));
  const auto told = Clock::now();
  server.reset();
  RecordProperty("milliseconds", static_cast<int>(Since(told).count()));
  EXPECT_LT(Since(told), milliseconds(1000));
  for (OpenConnection& one : crowd) EXPECT_TRUE(one.IsClosedWhileSaying('x', kPatience));
}

TEST(HttpAnsweringThreadsTest, AnAnswerThatTakesLongKeepsNobodyElseWaitingAndIsNotCrowdedOut) {
  std::promise<void> made;
  auto server = *HttpServer::Start({.answering_threads = 2, .most_connections = 4, .asking_time = kSoon},
                                   [&](const HttpRequest& request) {
                                     if (request.path == "/long") made.get_future().wait();
                                     return HttpAnswer{.body = "answer to " + request.path};
                                   });
  auto answer = std::async(std::launch::async, Converse, server->port(), "GET /long HTTP/1.1\r\n\r\n");
  EXPECT_THAT(Converse(server->port(), "GET /short HTTP/1.1\r\n\r\n"), EndsWith("answer to /short"));
  std::list<OpenConnection> idle;
  for (int i = 0; i < 8; ++i) idle.emplace_back(server->port(), "GET /half");
  EXPECT_THAT(Converse(server->port(), "GET /next HTTP/1.1\r\n\r\n"), EndsWith("answer to /next"));
  made.set_value();
  EXPECT_THAT(answer.get(), EndsWith("answer to /long"));
}

}  // namespace
}  // namespace gauntlet
