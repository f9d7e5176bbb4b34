#include "master/report/verdict_text.h"

namespace gauntlet::master {

std::string RuleOf(std::string_view message) {
  const std::size_t end = message.find(':');
  if (end == 0 || end == std::string_view::npos) return {};
  const std::string_view rule = message.substr(0, end);
  const bool is_name = rule.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string_view::npos;
  return is_name ? std::string(rule) : std::string();
}

std::string_view NameOf(sim::Verdict verdict) {
  switch (verdict) {
    case sim::Verdict::kCompleted:
      return "completed";
    case sim::Verdict::kRefused:
      return "refused";
    case sim::Verdict::kCrashed:
      return "crashed";
    case sim::Verdict::kHung:
      return "hung";
    case sim::Verdict::kOutOfMemory:
      return "out-of-memory";
    case sim::Verdict::kInvalidCommand:
      return "invalid-command";
  }
  return "unknown";
}

}  // namespace gauntlet::master
