#include "master/dispatch/dispatch_log.h"

#include <fmt/format.h>

#include <chrono>

#include "base/printable.h"
#include "proto/run_text.h"

namespace gauntlet {
namespace {

constexpr std::size_t kShownBytes = 300;    // of a text that came from a worker
constexpr std::size_t kMaxEvents = 1000;    // kept until somebody takes them
constexpr std::uint64_t kFailuresTold = 3;  // of a run that are alike
// Workers turned away of which events are made, for each of these times; the others are counted.
constexpr int kRefusalsTold = 10;
constexpr std::chrono::minutes kRefusalsToldFor{1};

}  // namespace

std::string Shorten(std::string_view text) {
  if (text.size() <= kShownBytes) return Printable(text);
  text.remove_prefix(text.size() - kShownBytes);
  const auto in_character = [&text] { return (static_cast<unsigned char>(text.front()) & 0xC0U) == 0x80U; };
  while (!text.empty() && in_character()) text.remove_prefix(1);
  return "..." + Printable(text);
}

void DispatchLog::Report(std::string kind, std::string_view text) {
  if (events_.size() >= kMaxEvents) events_.erase(events_.begin(), events_.begin() + kMaxEvents / 2);
  events_.push_back({std::move(kind), Printable(text)});
}

void DispatchLog::Failed(proto::RunId run, std::string kind, const std::string& how,
                         const std::string& where) {
  Failures& failures = failures_[run];
  failures.kind = std::move(kind);
  if (++failures.alike[how] <= kFailuresTold)
    Report(failures.kind, fmt::format("run {} {}{}", proto::RunText(run), how, where));
}

void DispatchLog::Ended(proto::RunId run) {
  const auto ended = failures_.extract(run);
  if (ended.empty()) return;
  for (const auto& [how, count] : ended.mapped().alike) {
    if (count > kFailuresTold)
      Report(ended.mapped().kind, fmt::format("run {} {}, {} times in all", proto::RunText(run), how, count));
  }
}

void DispatchLog::Reject(const std::string& kind, const std::string& text) {
  ++rejected_;
  if (rejected_kinds_.insert(kind).second) {
    Report(event::kRejectedMessage, text + "; it was dropped, and so will others of its kind without a word");
  }
}

void DispatchLog::Refuse(const std::string& label, const std::string& reason, TimePoint now) {
  ++refused_;
  last_refusal_ = reason;
  if (refusals_told_ == 0 || now >= refusals_told_since_ + kRefusalsToldFor) {
    refusals_told_ = 0;
    refusals_told_since_ = now;
  }
  if (refusals_told_ == kRefusalsTold) {
    ++refusals_untold_;
    return;
  }
  ++refusals_told_;
  const std::uint64_t untold = std::exchange(refusals_untold_, 0);
  Report(
      event::kWorkerRefused,
      fmt::format("worker {} was refused: {}{}", label, reason,
                  untold == 0 ? "" : fmt::format(" (and {} others since the last that was told)", untold)));
}

}  // namespace gauntlet
