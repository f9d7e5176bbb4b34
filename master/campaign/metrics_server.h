// Answers GET /metrics on this machine's own address with what was published last. It reads nothing but the
// request's first line, changes nothing, and knows nothing of the campaign.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "sim/base/result.h"

namespace gauntlet::master {

// One request at a time, at most 4 KiB of it, at most a second for it; further ones wait in the kernel's
// queue, and nothing of it touches the thread that publishes.
class MetricsServer {
 public:
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
  MetricsServer(int listener, int wake_up, int port);
  void Loop();
  void Answer(int connection);

  const int listener_;
  const int wake_up_;  // readable: end
  const int port_;
  std::mutex mutex_;  // guards the next
  std::string text_;
  std::thread thread_;
};

}  // namespace gauntlet::master
