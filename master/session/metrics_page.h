// Serves /metrics on this machine's own address: what was published last. It knows nothing of the campaign.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "base/result.h"
#include "master/http/http_server.h"

namespace gauntlet {

// Nothing of it touches the thread that publishes.
class MetricsPage {
 public:
  // `port`: 0 to 65535; 0 = any free one. kInUse when another program has it.
  static Result<std::unique_ptr<MetricsPage>> Serve(int port);

  // "http://127.0.0.1:9464/metrics"
  std::string url() const;
  // Thread-safe.
  void Publish(std::string text);

 private:
  HttpAnswer Answer(const HttpRequest& request);

  std::mutex mutex_;  // guards the next
  std::string text_;
  std::unique_ptr<HttpServer> server_;
};

}  // namespace gauntlet
