#include "tests/integration/ui_driver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include <fmt/format.h>

#include "tests/integration/campaign_driver.h"
#include "tests/support/local_socket.h"

namespace gauntlet::testing_support {

Ui::Ui(const std::string& dir) : process_(StartGauntlet({"ui", dir})) {
  EXPECT_TRUE(Eventually([&] { return process_->Out().ends_with("\n"); }, kPatience)) << process_->Err();
  address_ = process_->Out();
  if (!address_.empty()) address_.pop_back();
  EXPECT_THAT(address_, testing::MatchesRegex("http://127\\.0\\.0\\.1:[0-9]+/[0-9a-f]+/"));
}

int Ui::port() const {
  return std::atoi(address_.c_str() + address_.rfind(':') + 1);
}

std::string Ui::root() const {
  return address_.substr(address_.find('/', address_.rfind(':')));
}

std::string Ui::Get(const std::string& path, const std::string& headers) const {
  return Converse(port(), fmt::format("GET {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\n{}\r\n",
                                      path, port(), headers));
}

}  // namespace gauntlet::testing_support
