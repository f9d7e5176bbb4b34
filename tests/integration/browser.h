// Headless Chromium, told what to do over its debugging pipe (the Chrome DevTools Protocol).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/process.h"

namespace gauntlet::testing_support {

// The program's path; "" when there is none here. $GAUNTLET_BROWSER names another one.
std::string BrowserPath();

class Browser {
 public:
  // BrowserPath() must not be "". Its profile is deleted with the object.
  Browser();
  ~Browser();

  // A new page, waited for until it has loaded.
  void Open(const std::string& url, bool scripts = true);
  // The value of a JavaScript expression in the page; a test failure when it throws.
  nlohmann::json Evaluate(const std::string& expression);
  // Polls until the expression is true; false at the deadline.
  bool Becomes(const std::string& expression);
  void SetWidth(int pixels, bool dark = false);
  // PNG bytes of what is seen.
  std::string Screenshot();

  // What the pages have complained about: exceptions, errors and warnings of the console.
  const std::vector<std::string>& complaints() const { return complaints_; }
  // The addresses that they have asked for, data: left out.
  const std::vector<std::string>& requests() const { return requests_; }

 private:
  nlohmann::json Call(const std::string& method, const nlohmann::json& parameters = nlohmann::json::object());
  // The next message, taken down when it is an event. A null value at the deadline.
  nlohmann::json Receive();
  void TakeDown(const nlohmann::json& event);

  TemporaryDirectory profile_;
  int to_ = -1;
  int from_ = -1;
  std::string waiting_;  // received bytes of the next messages
  std::unique_ptr<Process> process_;
  std::string session_;
  int calls_ = 0;
  std::vector<std::string> complaints_;
  std::vector<std::string> requests_;
};

}  // namespace gauntlet::testing_support
