#include "proto/run_failure.h"

#include <fmt/format.h>

#include <csignal>
#include <cstring>
#include <optional>

#include "base/check.h"
#include "base/parse_number.h"

namespace gauntlet::proto {
namespace {

constexpr std::string_view kWithSignal = "crashed with signal ";
constexpr std::string_view kWithExitCode = "crashed with exit code ";

std::string SignalName(int number) {
  const char* name = sigabbrev_np(number);
  return name == nullptr ? "" : fmt::format("SIG{}", name);
}

std::string MeaningOfExit(int code) {
  switch (code) {
    case kExitUnheard:
      return "the controller closed files that are not its own";
    case kExitException:
      return "an exception that nobody caught";
    case kExitOverDisk:
      return "its folder grew beyond its limit";
    case kExitOverProcesses:
      return "it had more processes than it may";
    case kExitWithoutMetrics:
      return "its outcome could not be read";
    case kExitWithoutResult:
      return "exit was called before the run's end";
    default:
      break;
  }
  const std::string signal = code > kExitSignalled ? SignalName(code - kExitSignalled) : "";
  return signal.empty() ? "exit was called before the run's end" : signal + ", which its own process sent";
}

}  // namespace

std::string Describe(const RunnerFailure& failure) {
  switch (failure.kind) {
    case FailureKind::kCrashed:
      return failure.signal != 0 ? fmt::format("{}{}", kWithSignal, failure.signal)
                                 : fmt::format("{}{}", kWithExitCode, failure.exit_code);
    case FailureKind::kHung:
      return "exceeded its CPU time";
    case FailureKind::kOutOfMemory:
      return "exceeded its memory";
    case FailureKind::kExternal:
      return failure.signal != 0 ? fmt::format("was ended from outside by signal {}", failure.signal)
                                 : "was given back";
  }
  GAUNTLET_CHECK(false, "unknown kind of failure");
}

std::string Explained(std::string_view message) {
  const auto number_after = [message](std::string_view words) {
    return message.starts_with(words) ? ParseNumber<int>(message.substr(words.size())) : std::nullopt;
  };
  std::string meaning;
  if (const std::optional<int> signal = number_after(kWithSignal)) meaning = SignalName(*signal);
  if (const std::optional<int> code = number_after(kWithExitCode)) meaning = MeaningOfExit(*code);
  return meaning.empty() ? std::string(message) : fmt::format("{} ({})", message, meaning);
}

sim::RunResult ResultOf(const RunnerFailure& failure) {
  sim::RunResult result;
  result.verdict = failure.kind == FailureKind::kHung          ? sim::Verdict::kHung
                   : failure.kind == FailureKind::kOutOfMemory ? sim::Verdict::kOutOfMemory
                   : failure.kind == FailureKind::kExternal    ? sim::Verdict::kKilled
                                                               : sim::Verdict::kCrashed;
  result.message = Describe(failure);
  sim::SetHashes(result);
  return result;
}

}  // namespace gauntlet::proto
