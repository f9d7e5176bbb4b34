#include "report/ui/web_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/local_socket.h"

namespace gauntlet {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
using testing_support::Converse;

// What it was asked, in words.
WebAnswer Echo(const WebRequest& request) {
  return {.status = 403,
          .type = "text/plain",
          .body = request.method + " " + request.path + " " + request.host + " " + request.origin};
}

TEST(WebServerTest, HandsOnWhatWasAskedAndAnswersWhatItIsTold) {
  const auto server = WebServer::Start(0, Echo);
  ASSERT_TRUE(server) << server.error().message;
  EXPECT_THAT(Converse((*server)->port(),
                       "GET /a%2e%2e/b?c=d HTTP/1.1\r\nHost: here:1\r\nOrigin: http://there\r\n"
                       "Connection: close\r\n\r\n"),
              AllOf(StartsWith("HTTP/1.1 403"), HasSubstr("GET /a../b here:1 http://there"),
                    HasSubstr("frame-ancestors 'none'"), HasSubstr("Referrer-Policy: no-referrer")));
}

TEST(WebServerTest, AHeadIsTheSameWithoutItsBody) {
  const auto server =
      WebServer::Start(0, [](const WebRequest&) { return WebAnswer{.body = "twelve bytes"}; });
  ASSERT_TRUE(server) << server.error().message;
  const std::string rest = " / HTTP/1.1\r\nHost: here\r\nConnection: close\r\n\r\n";
  const std::string whole = Converse((*server)->port(), "GET" + rest);
  EXPECT_THAT(whole, AllOf(HasSubstr("Content-Length: 12\r\n"), EndsWith("\r\n\r\ntwelve bytes")));
  EXPECT_THAT(Converse((*server)->port(), "HEAD" + rest),
              AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("Content-Length: 12\r\n"), EndsWith("\r\n\r\n")));
}

// To compress a status costs more than to make it.
TEST(WebServerTest, SendsWhatItIsGivenAsItIs) {
  const std::string body(100'000, 'x');
  const auto server = WebServer::Start(0, [&](const WebRequest&) { return WebAnswer{.body = body}; });
  ASSERT_TRUE(server) << server.error().message;
  EXPECT_THAT(
      Converse((*server)->port(), "GET / HTTP/1.1\r\nHost: here\r\nAccept-Encoding: br, gzip\r\n\r\n"),
      EndsWith("\r\n\r\n" + body))
      << "and closes the connection";
}

TEST(WebServerTest, SurvivesWhatIsNoHttp) {
  const auto server = WebServer::Start(0, Echo);
  ASSERT_TRUE(server) << server.error().message;
  Converse((*server)->port(), std::string(100'000, 'x') + "\r\n\r\n");
  Converse((*server)->port(), "POST / HTTP/1.1\r\nHost: here\r\nContent-Length: -1\r\n\r\n");
  EXPECT_THAT(Converse((*server)->port(), "GET / HTTP/1.1\r\nHost: here\r\nConnection: close\r\n\r\n"),
              HasSubstr("GET / here"));
}

TEST(WebServerTest, APortThatIsTakenIsNamed) {
  const testing_support::ListeningSocket other;
  const auto server = WebServer::Start(other.port(), Echo);
  ASSERT_FALSE(server);
  EXPECT_EQ(server.error().kind, ErrorKind::kInUse);
  EXPECT_THAT(server.error().message, AllOf(HasSubstr(std::to_string(other.port())), HasSubstr("--port")));
}

TEST(WebServerTest, TwoDoNotShareAPort) {
  const auto first = WebServer::Start(0, Echo);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_FALSE(WebServer::Start((*first)->port(), Echo));
}

}  // namespace
}  // namespace gauntlet
