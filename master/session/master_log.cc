#include "master/session/master_log.h"

#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <utility>

#include "base/system/regular_file.h"

namespace gauntlet {

Status OpenMasterLog(const std::string& path, const LogLimits& limits) {
  for (const Status& usable :
       {MakeDirectory(std::filesystem::path(path).parent_path()), CheckRegularFile(path)}) {
    if (!usable && usable.error().kind == ErrorKind::kInvalidInput) return usable;
  }
  try {
    auto sink = std::make_shared<spdlog::sinks::rotating_file_sink_mt>(path, limits.bytes, limits.former);
    auto logger = std::make_shared<spdlog::logger>("master", std::move(sink));
    logger->flush_on(spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
  } catch (const spdlog::spdlog_ex&) {
    spdlog::set_level(spdlog::level::off);
  }
  return Ok{};
}

}  // namespace gauntlet
