#include "master/http/http_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/local_socket.h"

namespace gauntlet {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
using testing_support::Converse;

// What it was asked, in words.
HttpAnswer Echo(const HttpRequest& request) {
  return {
      .status = 403, .type = "text/plain", .body = request.path + " " + request.host + " " + request.origin};
}

// By as many threads as answer for it.
class HttpServerTest : public testing::TestWithParam<std::size_t> {
 protected:
  std::unique_ptr<HttpServer> Start(HttpHandler answer) {
    return *HttpServer::Start({.answering_threads = GetParam()}, std::move(answer));
  }
};

INSTANTIATE_TEST_SUITE_P(AnsweringThreads, HttpServerTest, testing::Values(0, 4));

TEST_P(HttpServerTest, HandsOnWhatWasAskedAndAnswersWhatItIsTold) {
  const auto server = Start(Echo);
  EXPECT_THAT(Converse(server->port(),
                       "GET /a%2e%2e/%zz%b?c=d HTTP/1.1\r\nHost: here:1\r\nOrigin: http://there\r\n\r\n"),
              AllOf(StartsWith("HTTP/1.1 403 Forbidden\r\nContent-Type: text/plain\r\n"),
                    EndsWith("\r\n\r\n/a../%zz%b here:1 http://there"), HasSubstr("frame-ancestors 'none'"),
                    HasSubstr("Referrer-Policy: no-referrer"), HasSubstr("Cache-Control: no-store"),
                    HasSubstr("X-Content-Type-Options: nosniff"),
                    HasSubstr("Cross-Origin-Resource-Policy: same-origin")));
}

TEST_P(HttpServerTest, AHeadIsTheSameWithoutItsBody) {
  const auto server = Start([](const HttpRequest&) { return HttpAnswer{.body = "twelve bytes"}; });
  const std::string rest = " / HTTP/1.1\r\nHost: here\r\nConnection: close\r\n\r\n";
  const std::string whole = Converse(server->port(), "GET" + rest);
  EXPECT_THAT(whole, AllOf(HasSubstr("Content-Length: 12\r\n"), EndsWith("\r\n\r\ntwelve bytes")));
  EXPECT_THAT(Converse(server->port(), "HEAD" + rest),
              AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("Content-Length: 12\r\n"), EndsWith("\r\n\r\n")));
}

// To compress a status costs more than to make it.
TEST_P(HttpServerTest, SendsWhatItIsGivenAsItIs) {
  const std::string body(8 << 20, 'x');  // more than a socket takes at once
  const auto server = Start([&](const HttpRequest&) { return HttpAnswer{.body = body}; });
  const std::string answer =
      Converse(server->port(), "GET / HTTP/1.1\r\nHost: here\r\nAccept-Encoding: br, gzip\r\n\r\n");
  EXPECT_EQ(answer.substr(answer.find("\r\n\r\n") + 4).size(), body.size()) << "and closes the connection";
}

TEST_P(HttpServerTest, OnlyGetAndHeadAreAnswered) {
  const auto server = Start(Echo);
  for (const std::string method : {"POST", "PUT", "OPTIONS", "DELETE", "BREW"}) {
    EXPECT_THAT(Converse(server->port(), method + " / HTTP/1.1\r\nContent-Length: 4\r\n\r\nbody"),
                AllOf(StartsWith("HTTP/1.1 405 "), HasSubstr("\r\nAllow: GET, HEAD\r\n"),
                      EndsWith("only GET and HEAD are answered here\n")))
        << method;
  }
}

TEST_P(HttpServerTest, WhatIsNoHttpIsRefused) {
  const auto server = Start(Echo);
  for (const std::string nonsense :
       {"nonsense\r\n\r\n", "GET / HTTP/9.1\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/1.1\r\nno colon\r\n\r\n",
        "\x16\x03\x01\x02\x01\x01 the greeting of TLS", "POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
        "GET / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n"})
    EXPECT_THAT(Converse(server->port(), nonsense), StartsWith("HTTP/1.1 400 Bad Request\r\n")) << nonsense;
  EXPECT_THAT(Converse(server->port(), "GET / HTTP/1.0\r\nHost: here\r\n\r\n"), HasSubstr("/ here"));
}

// It hears so although it has not sent all of it.
TEST_P(HttpServerTest, WhatIsTooLongIsRefused) {
  const auto server = Start(Echo);
  EXPECT_THAT(Converse(server->port(), "GET /" + std::string(100'000, 'x')), StartsWith("HTTP/1.1 431 "));
  EXPECT_THAT(Converse(server->port(), "GET / HTTP/1.1\r\nX: " + std::string(100'000, 'x') + "\r\n\r\n"),
              StartsWith("HTTP/1.1 431 "));
  const std::string body(1 << 20, 'x');
  EXPECT_THAT(Converse(server->port(),
                       fmt::format("POST / HTTP/1.1\r\nContent-Length: {}\r\n\r\n{}", body.size(), body)),
              StartsWith("HTTP/1.1 413 "));
  EXPECT_THAT(Converse(server->port(), fmt::format("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n{:x}"
                                                   "\r\n{}\r\n0\r\n\r\n",
                                                   body.size(), body)),
              StartsWith("HTTP/1.1 413 "));
}

TEST_P(HttpServerTest, AnAnswerThatCannotBeMadeEndsNothing) {
  const auto server = Start([](const HttpRequest& request) -> HttpAnswer {
    if (request.path == "/") throw std::runtime_error("no field 'runs'");
    return {.body = "fine"};
  });
  EXPECT_THAT(Converse(server->port(), "GET / HTTP/1.1\r\n\r\n"),
              AllOf(StartsWith("HTTP/1.1 500 "), EndsWith("\r\n\r\nno field 'runs'\n")));
  EXPECT_THAT(Converse(server->port(), "GET /other HTTP/1.1\r\n\r\n"), EndsWith("fine"));
}

TEST(HttpServerPortTest, APortThatIsTakenIsNamed) {
  const testing_support::ListeningSocket other;
  const auto server = HttpServer::Start({.port = other.port(), .failure = "cannot serve this"}, Echo);
  ASSERT_FALSE(server);
  EXPECT_EQ(server.error().kind, ErrorKind::kInUse);
  EXPECT_EQ(server.error().message,
            fmt::format("cannot serve this on 127.0.0.1:{}: Address already in use", other.port()));
}

TEST(HttpServerPortTest, TwoDoNotShareAPortAndItIsFreeAfterwards) {
  auto first = *HttpServer::Start({}, Echo);
  const int port = first->port();
  EXPECT_FALSE(HttpServer::Start({.port = port}, Echo));
  Converse(port, "GET / HTTP/1.1\r\n\r\n");
  first.reset();
  EXPECT_TRUE(HttpServer::Start({.port = port}, Echo));
}

}  // namespace
}  // namespace gauntlet
