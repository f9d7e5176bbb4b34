#include "study/fits/fit_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/sample.h"
#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "proto/json_text.h"

namespace gauntlet {
namespace {

constexpr const char* kTitle = "Settings that are likely, given what was measured";

Table KeyTable(const FitResult& fit) {
  Table table({{"key", "key"},
               {"range", "range"},
               {"chosen", "chosen"},
               {"likely (90 %)", "likely"},
               ForPrograms("determined"),
               {""}});
  for (const FittedKey& key : fit.keys)
    table.AddRow({key.path, key.range, Cell(key.chosen.empty() ? "-" : key.chosen, TextValue(key.chosen)),
                  Cell(key.likely.empty() ? "-" : key.likely, TextValue(key.likely)), Cell(key.determined),
                  key.determined ? "" : "not determined"});
  return table;
}

Table TargetTable(const FitResult& fit) {
  Table table({{"target", "target"},
               {"wanted", "wanted"},
               ForPrograms("metric"),
               ForPrograms("statistic"),
               ForPrograms("value?"),
               ForPrograms("at_most?"),
               ForPrograms("at_least?"),
               {">ours", "ours"},
               {"(95 %)", "interval"},
               {">standard errors away", "misfit"},
               {"", "met"}});
  for (std::size_t i = 0; i < fit.targets.size(); ++i) {
    const JudgedTarget& target = fit.targets[i];
    const FitTarget& asked = fit.plan.targets[i];
    const auto wanted = [&](bool here) {
      return here ? Cell(analysis::Describe(asked.values).mean) : TextCell("");
    };
    const bool at_most = asked.demand == FitTarget::Demand::kAtMost;
    const bool at_least = asked.demand == FitTarget::Demand::kAtLeast;
    table.AddRow({target.title, target.wanted, TextCell(asked.metric), asked.StatisticText(),
                  wanted(!at_most && !at_least), wanted(at_most), wanted(at_least),
                  DecimalCell(target.ours, 3), IntervalCell(target.interval), DecimalCell(target.misfit, 1),
                  Cell(target.met ? "met" : "NOT MET", target.met)});
  }
  return table;
}

std::vector<std::string> UndeterminedKeys(const FitResult& fit) {
  std::vector<std::string> open;
  for (const FittedKey& key : fit.keys) {
    if (!key.determined) open.push_back(key.path);
  }
  return open;
}

// {KEY: value}; `value_of` a key's number.
template <class ValueOf>
nlohmann::ordered_json SettingJson(const FitResult& fit, const ValueOf& value_of) {
  nlohmann::ordered_json setting = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < fit.plan.varied.size(); ++i) {
    const KeyValue value = value_of(i);
    setting[fit.plan.varied[i].key.path] =
        std::visit([](const auto& held) { return JsonValue(Value(held)); }, value);
  }
  return setting;
}

// The sentences below the settings.
std::vector<std::string> WhatKeysSay(const FitResult& fit) {
  std::vector<std::string> sentences;
  if (const std::vector<std::string> open = UndeterminedKeys(fit); !open.empty())
    sentences.push_back(
        fmt::format("These targets do not determine {}: the likely values fill more than {:.0f} % of "
                    "the range, or every choice is left.",
                    fmt::join(open, ", "), 100.0 * kUndetermined));
  for (const TradeOff& one : fit.trade_offs) {
    sentences.push_back(fmt::format(
        "{} and {} make up for each other: where one is {}, the other is {} (rank correlation {:.2f}).",
        one.one, one.other, "higher", one.correlation > 0.0 ? "higher too" : "lower", one.correlation));
  }
  return sentences;
}

}  // namespace

std::string OutcomeOf(const FitResult& fit) {
  if (!fit.why.empty()) return fmt::format("There is nothing to choose from: {}.", fit.why);
  if (!fit.finished) return "The fit is not finished: what stands here is what is known by now.";
  if (fit.targets.empty()) return "No setting of the ranges can be simulated and is likely.";
  const auto met = std::ranges::count(fit.targets, true, &JudgedTarget::met);
  if (fit.Met()) return "The chosen setting meets every target.";
  return fmt::format("The chosen setting meets {} of {} targets.", met, fit.targets.size());
}

std::vector<Section> TellFit(const FitResult& fit, const std::string& dir, const std::string& program) {
  Section settings{.title = kTitle, .table = KeyTable(fit), .sentences = WhatKeysSay(fit)};
  settings.lead = {fmt::format(
      "{} runs of {} were held against {}{}.", FormatCount(fit.runs),
      Counted(fit.settings + fit.candidates, "setting"), Counted(fit.plan.targets.size(), "target"),
      fit.candidates > 1 ? fmt::format("; {} of the settings were judged on fresh cases, the last is "
                                       "the chosen one",
                                       fit.candidates)
                         : "")};
  if (fit.without_result > 0)
    settings.lead.push_back(
        fmt::format("{} of the runs ended without a result.", FormatCount(fit.without_result)));
  if (fit.refused > 0.0)
    settings.lead.push_back(
        fmt::format("About {:.3g} % of the ranges was never simulated: settings there break a rule of the "
                    "experiment.",
                    100.0 * fit.refused));
  Section targets{.title = "Targets, and what the chosen setting gives in fresh runs",
                  .table = TargetTable(fit)};
  if (fit.targets.empty()) targets.title = "Targets";
  targets.sentences = {OutcomeOf(fit)};
  targets.sentences.insert(targets.sentences.end(), fit.contradictions.begin(), fit.contradictions.end());
  const std::string place = PastedPath(dir);
  if (!fit.finished) {
    targets.commands = {{fmt::format("{} resume {}", program, place), "go on"}};
  } else if (fit.fitted) {
    targets.commands = {
        {fmt::format("{} fit {} -o fitted.toml", program, place), "the chosen setting as an experiment"},
        {fmt::format("{} fit {} --predict fitted.toml --draws 20", program, place),
         "what the other accepted settings would make of a result"},
        {fmt::format("{} figure {} settings -o settings.svg --csv settings.csv", program, place),
         "all accepted settings with their weights"},
        {fmt::format("{} report {} -o fit.html", program, place), "the same as a page"}};
  }
  return {std::move(settings), std::move(targets)};
}

std::string FitJson(const FitResult& fit, const std::string& dir) {
  nlohmann::ordered_json trade_offs = nlohmann::ordered_json::array();
  for (const TradeOff& one : fit.trade_offs)
    trade_offs.push_back({{"keys", {one.one, one.other}}, {"rank_correlation", one.correlation}});
  nlohmann::ordered_json accepted = nlohmann::ordered_json::array();
  for (const AcceptedSetting& one : fit.accepted) {
    const auto value_of = [&](std::size_t key) { return fit.plan.varied[key].ValueAt(one.place[key]); };
    // A likelihood knows no distance.
    accepted.push_back(
        {{"weight", one.weight}, {"distance", nullptr}, {"values", SettingJson(fit, value_of)}});
  }
  nlohmann::ordered_json chosen;
  if (fit.fitted)
    chosen = SettingJson(fit, [&](std::size_t key) { return fit.plan.varied[key].key.get(*fit.fitted); });
  return JsonText({{"directory", dir},
                   {"finished", fit.finished},
                   {"met", fit.Met()},
                   {"runs", fit.runs},
                   {"without_result", fit.without_result},
                   {"settings", fit.settings},
                   {"judged", fit.candidates},
                   {"refused", fit.refused},
                   {"accepted_count", fit.accepted.size()},
                   {"chosen", std::move(chosen)},
                   {"undetermined", UndeterminedKeys(fit)},
                   {"keys", KeyTable(fit).ToJson()},
                   {"trade_offs", std::move(trade_offs)},
                   {"targets", TargetTable(fit).ToJson()},
                   {"contradictions", fit.contradictions},
                   {"outcome", OutcomeOf(fit)},
                   {"accepted", std::move(accepted)}});
}

}  // namespace gauntlet
