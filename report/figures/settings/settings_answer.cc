#include "report/figures/settings/settings_answer.h"

#include "report/figures/settings/fit_figure.h"
#include "report/figures/settings/margin_figure.h"
#include "report/figures/settings/repair_figure.h"
#include "study/fits/fit_text.h"

namespace gauntlet {

std::optional<SettingsAnswer> SettingsAnswerOf(const CampaignFacts& facts) {
  const std::string& dir = facts.directory;
  if (facts.fit)
    return SettingsAnswer{OutcomeOf(*facts.fit), TellFit(*facts.fit, dir, "gauntlet"), FitFigures(facts)};
  if (!facts.margins.empty())
    return SettingsAnswer{OutcomeOf(facts.margins.front()), TellMargins(facts.margins, dir, "gauntlet"),
                          MarginFigures(facts)};
  if (facts.repair)
    return SettingsAnswer{OutcomeOf(*facts.repair), TellRepair(*facts.repair, dir, "gauntlet"),
                          RepairFigures(facts)};
  if (facts.probability)
    return SettingsAnswer{
        OutcomeOf(*facts.probability), TellProbability(*facts.probability, dir, "gauntlet"), {}};
  return std::nullopt;
}

}  // namespace gauntlet
