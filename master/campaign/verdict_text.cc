#include "master/campaign/verdict_text.h"

#include <iterator>

namespace gauntlet {

std::string RuleOf(std::string_view message) {
  const std::size_t end = message.find(':');
  if (end == 0 || end == std::string_view::npos) return {};
  const std::string_view rule = message.substr(0, end);
  const bool is_name = rule.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string_view::npos;
  return is_name ? std::string(rule) : std::string();
}

std::string_view NameOf(sim::Verdict verdict) {
  constexpr std::string_view kNames[] = {"unknown", "completed",     "refused",         "crashed",
                                         "hung",    "out-of-memory", "invalid-command", "killed"};
  const auto number = static_cast<std::size_t>(verdict);
  return kNames[number < std::size(kNames) ? number : 0];
}

}  // namespace gauntlet
