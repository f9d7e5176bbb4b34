#include "tests/integration/browser.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace gauntlet::testing_support {
namespace {

using Json = nlohmann::json;

// [read, write]; the end that the child gets survives exec.
std::pair<int, int> MakePipe(bool child_reads) {
  int ends[2] = {-1, -1};
  EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
  (void)fcntl(child_reads ? ends[0] : ends[1], F_SETFD, 0);
  return {ends[0], ends[1]};
}

// Bytes of base64.
std::string Decoded(const std::string& text) {
  static const std::string kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char letter : text) {
    const std::size_t value = kLetters.find(letter);
    if (value == std::string::npos) break;
    bits = bits << 6U | static_cast<unsigned>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 255U);
  }
  return bytes;
}

}  // namespace

std::string BrowserPath() {
  if (const char* chosen = std::getenv("GAUNTLET_BROWSER")) return chosen;
  for (const char* path : {"/usr/bin/chromium-headless-shell", "/usr/bin/chromium",
                           "/usr/bin/chromium-browser", "/usr/bin/google-chrome"}) {
    if (std::filesystem::exists(path)) return path;
  }
  return "";
}

Browser::Browser() {
  const auto [commands_out, commands_in] = MakePipe(true);
  const auto [answers_out, answers_in] = MakePipe(false);
  to_ = commands_in;
  from_ = answers_out;
  // The protocol speaks on descriptors 3 and 4.
  const std::string redirect =
      "exec \"$@\" 3<&" + std::to_string(commands_out) + " 4>&" + std::to_string(answers_in);
  process_ = std::make_unique<Process>(std::vector<std::string>{
      "/bin/bash", "-c", redirect, "browser", BrowserPath(), "--headless", "--remote-debugging-pipe",
      "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
      "--user-data-dir=" + profile_.path()});
  close(commands_out);
  close(answers_in);
}

Browser::~Browser() {
  session_.clear();
  Call("Browser.close");
  process_->Wait();
  close(to_);
  close(from_);
}

Json Browser::Receive() {
  for (;;) {
    const std::size_t end = waiting_.find('\0');
    if (end != std::string::npos) {
      const Json message = Json::parse(waiting_.substr(0, end));
      waiting_.erase(0, end + 1);
      if (message.contains("method")) TakeDown(message);
      return message;
    }
    pollfd ready{from_, POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(std::chrono::milliseconds(kPatience).count())) != 1) return {};
    char buffer[65536];
    const ssize_t size = read(from_, buffer, sizeof buffer);
    if (size <= 0) return {};
    waiting_.append(buffer, static_cast<std::size_t>(size));
  }
}

void Browser::TakeDown(const Json& event) {
  const std::string method = event["method"];
  const Json& parameters = event["params"];
  if (method == "Runtime.exceptionThrown") complaints_.push_back(parameters.dump());
  if (method == "Log.entryAdded") complaints_.push_back(parameters.dump());
  if (method == "Runtime.consoleAPICalled" && parameters["type"] != "log")
    complaints_.push_back(parameters.dump());
  if (method == "Network.requestWillBeSent") {
    const std::string url = parameters["request"]["url"];
    if (!url.starts_with("data:")) requests_.push_back(url);
  }
}

Json Browser::Call(const std::string& method, const Json& parameters) {
  Json message = {{"id", ++calls_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump() + '\0';
  EXPECT_EQ(write(to_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  for (;;) {
    const Json answer = Receive();
    if (answer.is_null()) {
      ADD_FAILURE() << "no answer to " << method << "\n" << process_->Err();
      return answer;
    }
    if (answer.value("id", 0) != calls_) continue;
    EXPECT_FALSE(answer.contains("error")) << method << ": " << answer;
    return answer.value("result", Json::object());
  }
}

void Browser::Open(const std::string& url, bool scripts) {
  session_.clear();
  const Json target = Call("Target.createTarget", {{"url", "about:blank"}});
  const Json attached =
      Call("Target.attachToTarget", {{"targetId", target.value("targetId", "")}, {"flatten", true}});
  session_ = attached.value("sessionId", "");
  for (const char* domain : {"Page", "Runtime", "Network", "Log"}) Call(std::string(domain) + ".enable");
  Call("Emulation.setScriptExecutionDisabled", {{"value", !scripts}});
  Call("Page.navigate", {{"url", url}});
  EXPECT_TRUE(Becomes("location.protocol !== 'about:' && document.readyState === 'complete'")) << url;
}

Json Browser::Evaluate(const std::string& expression) {
  const Json answer =
      Call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  EXPECT_FALSE(answer.contains("exceptionDetails")) << expression << ": " << answer;
  return answer.contains("result") ? answer["result"].value("value", Json()) : Json();
}

bool Browser::Becomes(const std::string& expression) {
  return Eventually([&] { return Evaluate(expression) == true; }, kPatience);
}

void Browser::SetWidth(int pixels, bool dark) {
  Call("Emulation.setDeviceMetricsOverride",
       {{"width", pixels}, {"height", 1400}, {"deviceScaleFactor", 1}, {"mobile", pixels < 600}});
  Call("Emulation.setEmulatedMedia",
       {{"features", Json::array({{{"name", "prefers-color-scheme"}, {"value", dark ? "dark" : "light"}}})}});
}

std::string Browser::Screenshot() {
  return Decoded(Call("Page.captureScreenshot").value("data", ""));
}

}  // namespace gauntlet::testing_support
