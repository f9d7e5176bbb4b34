// What a search over settings has found: a fit, margins, a repair or a failure probability.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/tables/section.h"
#include "report/figures/campaign_figures.h"

namespace gauntlet {

struct SettingsAnswer {
  std::string outcome;  // a sentence
  std::vector<Section> sections;
  std::vector<NamedFigure> figures;
};
// Nothing of a campaign whose searches vary no settings.
std::optional<SettingsAnswer> SettingsAnswerOf(const CampaignFacts& facts);

}  // namespace gauntlet
