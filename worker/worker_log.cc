#include "worker/worker_log.h"

#include <fmt/format.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <memory>
#include <utility>
#include <vector>

namespace gauntlet::worker {

Status StartLogging(const std::string& file, bool quiet, const LogLimits& limits) {
  try {
    auto to_stderr = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    std::vector<spdlog::sink_ptr> sinks{to_stderr};
    if (!file.empty()) {
      // What ends the worker stands on stderr too: whoever started it may not look into the file.
      to_stderr->set_level(spdlog::level::err);
      sinks.push_back(
          std::make_shared<spdlog::sinks::rotating_file_sink_mt>(file, limits.bytes, limits.former));
    }
    auto logger = std::make_shared<spdlog::logger>("worker", sinks.begin(), sinks.end());
    logger->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
    logger->flush_on(spdlog::level::info);
    logger->set_pattern(fmt::format("%Y-%m-%d %H:%M:%S.%e worker {} %l: %v", getpid()));
    spdlog::set_default_logger(std::move(logger));
  } catch (const spdlog::spdlog_ex& error) {
    return InvalidInput(error.what());
  }
  return Ok{};
}

}  // namespace gauntlet::worker
