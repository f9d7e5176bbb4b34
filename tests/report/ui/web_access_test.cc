#include "report/ui/web_access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet {
namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef";

HttpRequest RequestOf(const std::string& path) {
  return {.path = path, .host = "127.0.0.1:8080", .origin = ""};
}

// 200 for one that is let in.
int StatusOf(const HttpRequest& request) {
  const Admission admission = Admit(request, kToken);
  return admission.refusal ? admission.refusal->status : 200;
}

TEST(WebAccessTest, WhoKnowsTheTokenGetsThePathBehindIt) {
  const Admission first = Admit(RequestOf("/" + kToken + "/"), kToken);
  EXPECT_FALSE(first.refusal.has_value());
  EXPECT_EQ(first.path, "");
  EXPECT_EQ(Admit(RequestOf("/" + kToken + "/run/0/17"), kToken).path, "run/0/17");
}

TEST(WebAccessTest, WithoutTheTokenNothingIsAnswered) {
  const std::string other(kToken.size(), '0');
  for (const std::string& path :
       {std::string("/"), std::string(""), std::string("/status"), "/" + kToken, "/" + kToken.substr(1) + "/",
        "/" + other + "/", "/" + kToken + "0/", "//" + kToken + "/"}) {
    EXPECT_EQ(StatusOf(RequestOf(path)), 403) << path;
  }
}

TEST(WebAccessTest, ANameOfSomebodyElseThatPointsHereIsRefused) {
  HttpRequest request = RequestOf("/" + kToken + "/");
  for (const std::string host :
       {"evil.example:8080", "", "127.0.0.1.evil.example", "localhost.evil.example:80"}) {
    request.host = host;
    EXPECT_EQ(StatusOf(request), 403) << host;
  }
  for (const std::string host : {"localhost:8080", "localhost:9000", "127.0.0.1"}) {  // through a tunnel
    request.host = host;
    EXPECT_EQ(StatusOf(request), 200) << host;
  }
}

TEST(WebAccessTest, PagesOfOtherSitesAreRefused) {
  HttpRequest request = RequestOf("/" + kToken + "/status");
  for (const std::string origin :
       {"http://evil.example", "null", "http://127.0.0.1:9999", "https://127.0.0.1:8080"}) {
    request.origin = origin;
    EXPECT_EQ(StatusOf(request), 403) << origin;
  }
  request.origin = "http://127.0.0.1:8080";
  EXPECT_EQ(StatusOf(request), 200);
}

TEST(WebAccessTest, NoPathLeadsUpwards) {
  EXPECT_EQ(StatusOf(RequestOf("/" + kToken + "/../../etc/passwd")), 404);
  EXPECT_EQ(StatusOf(RequestOf("/../" + kToken + "/")), 403);
}

TEST(WebAccessTest, EveryTokenIsNew) {
  const std::string token = NewToken();
  EXPECT_THAT(token, testing::MatchesRegex("[0-9a-f]+"));
  EXPECT_EQ(token.size(), 32U);
  EXPECT_NE(token, NewToken());
}

}  // namespace
}  // namespace gauntlet
