// Answers GET /metrics on this machine's own address with what was published last. It reads nothing but the
// request's first line, changes nothing, and knows nothing of the campaign.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "base/result.h"
#include "base/system/unique_fd.h"

namespace gauntlet {

// One thread serves all connections side by side: at most 4 KiB of a request, at most a second for a
// connection, at most kMostConnections of them. When one more comes, the oldest that has not asked for
// anything yet is closed. Nothing of it touches the thread that publishes.
class MetricsServer {
 public:
  static constexpr std::size_t kMostConnections = 128;

  // Listens on 127.0.0.1. `port`: 0 to 65535; 0 = any free one. kInUse when another program has it.
  static Result<std::unique_ptr<MetricsServer>> Start(int port);
  MetricsServer(const MetricsServer&) = delete;
  MetricsServer& operator=(const MetricsServer&) = delete;
  ~MetricsServer();

  int port() const { return port_; }
  // "http://127.0.0.1:9464/metrics"
  std::string url() const;
  // Thread-safe.
  void Publish(std::string text);

 private:
  class Connection;

  MetricsServer(UniqueFd listener, int port);
  void Loop();
  // Takes those that wait. False when the system has no descriptor for one.
  bool Accept(std::list<Connection>& connections);
  // To a whole request.
  std::string AnswerTo(std::string_view request);

  const UniqueFd listener_;
  const int port_;
  std::mutex mutex_;  // guards the next
  std::string text_;
  std::thread thread_;
};

}  // namespace gauntlet
