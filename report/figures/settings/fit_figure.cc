#include "report/figures/settings/fit_figure.h"

#include <fmt/format.h>

#include "analysis/figures/pairs_figure.h"
#include "base/number_text.h"

namespace gauntlet {
namespace {

constexpr const char* kSettingsTitle = "Accepted settings";

analysis::PairsFigure PairsOf(const FitResult& fit) {
  analysis::PairsFigure figure{
      .title = kSettingsTitle,
      .outcome = fmt::format("{} draws, {} of them different", FormatCount(fit.draws.size()),
                             FormatCount(fit.accepted.size())),
      .axes = {},
      .points = fit.draws,
      .chosen = fit.chosen.value_or(SettingsPoint())};
  for (const VariedKey& key : fit.plan.varied) {
    const std::size_t dot = key.key.path.rfind('.');
    const auto end = [&](double place) {
      const KeyValue value = key.ValueAt(place);
      const auto* number = std::get_if<double>(&value);
      return number == nullptr ? ToSet(value) : fmt::format("{:.3g}", *number);
    };
    figure.axes.push_back({key.key.path.substr(dot == std::string::npos ? 0 : dot + 1), end(0.0), end(1.0)});
  }
  return figure;
}

}  // namespace

std::vector<NamedFigure> FitFigures(const CampaignFacts& facts) {
  if (!facts.fit || facts.fit->draws.empty()) return {};
  return {
      {"settings", kSettingsTitle,
       "Each point is a setting that is likely, given what was measured. A key whose bars fill its range is "
       "not determined, and points along a line are keys that make up for each other.",
       [fit = *facts.fit] { return analysis::DrawPairs(PairsOf(fit)); },
       [fit = *facts.fit] { return AcceptedCsv(fit); }}};
}

}  // namespace gauntlet
