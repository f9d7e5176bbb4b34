#include "master/session/metrics_page.h"

#include <utility>

#include <fmt/format.h>

namespace gauntlet {

Result<std::unique_ptr<MetricsPage>> MetricsPage::Serve(int port) {
  auto page = std::make_unique<MetricsPage>();
  TRY(page->server_,
      HttpServer::Start({.port = port, .failure = "cannot serve metrics"},
                        [&page = *page](const HttpRequest& request) { return page.Answer(request); }));
  return page;
}

std::string MetricsPage::url() const {
  return fmt::format("http://127.0.0.1:{}/metrics", server_->port());
}

void MetricsPage::Publish(std::string text) {
  const std::lock_guard lock(mutex_);
  text_ = std::move(text);
}

HttpAnswer MetricsPage::Answer(const HttpRequest& request) {
  if (request.path != "/metrics") return {.status = 404, .body = "only /metrics is served here\n"};
  const std::lock_guard lock(mutex_);
  if (text_.empty()) return {.status = 503, .body = "the master is starting\n"};
  return {.type = "text/plain; version=0.0.4; charset=utf-8", .body = text_};
}

}  // namespace gauntlet
