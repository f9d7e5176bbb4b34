#include "master/session/master_log.h"

#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/spdlog.h>

#include <utility>

namespace gauntlet::master {

void OpenMasterLog(const std::string& path, const LogLimits& limits) {
  try {
    auto sink = std::make_shared<spdlog::sinks::rotating_file_sink_mt>(path, limits.bytes, limits.former);
    auto logger = std::make_shared<spdlog::logger>("master", std::move(sink));
    logger->flush_on(spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
  } catch (const spdlog::spdlog_ex&) {
    spdlog::set_level(spdlog::level::off);
  }
}

}  // namespace gauntlet::master
