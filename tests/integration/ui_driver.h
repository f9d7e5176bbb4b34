// A living `gauntlet ui`, and what is asked of it without a browser.
#pragma once

#include <memory>
#include <string>

#include "tests/support/process.h"

namespace gauntlet::testing_support {

class Ui {
 public:
  // A test failure when it prints no address.
  explicit Ui(const std::string& dir);

  // "http://127.0.0.1:43211/TOKEN/"
  const std::string& address() const { return address_; }
  int port() const;
  // "/TOKEN/"
  std::string root() const;
  Process& process() { return *process_; }

  // The whole answer to a GET.
  std::string Get(const std::string& path, const std::string& headers = "") const;

 private:
  std::unique_ptr<Process> process_;
  std::string address_;
};

}  // namespace gauntlet::testing_support
