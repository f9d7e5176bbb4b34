#include "master/cli/confirmation_table.h"

#include <algorithm>
#include <ranges>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "master/cli/table.h"

namespace gauntlet::master {

std::string ConfirmationsText(const std::vector<Confirmation>& confirmations, std::size_t most) {
  Table table({"case", ">failed", "probability (95 %)", "verdict", ""});
  for (const Confirmation& one : confirmations | std::views::take(static_cast<std::ptrdiff_t>(most))) {
    table.AddRow({Printable(one.name), fmt::format("{} of {}", one.tally.failures, one.tally.runs()),
                  fmt::format("{:3.0f} to {:3.0f} %", 100.0 * one.interval.low, 100.0 * one.interval.high),
                  std::string(NameOf(one.verdict)), Printable(one.message)});
  }
  const auto confirmed = std::ranges::count(confirmations, FailureVerdict::kFail, &Confirmation::verdict);
  std::string text = table.ToText();
  if (confirmations.size() > most) {
    text += fmt::format("  and {} more; see show --json\n", confirmations.size() - most);
  }
  return fmt::format("{}{} of {} cases confirmed: with fresh seeds they fail in at least half of the runs.\n",
                     text, confirmed, confirmations.size());
}

nlohmann::ordered_json ConfirmationsJson(const std::vector<Confirmation>& confirmations) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Confirmation& one : confirmations) {
    list.push_back({{"run", one.run > 0 ? nlohmann::ordered_json(one.run) : nlohmann::ordered_json()},
                    {"case", one.name},
                    {"k", one.tally.failures},
                    {"n", one.tally.runs()},
                    {"interval", {one.interval.low, one.interval.high}},
                    {"verdict", NameOf(one.verdict)}});
    if (!one.message.empty()) list.back()["message"] = one.message;
  }
  return list;
}

}  // namespace gauntlet::master
