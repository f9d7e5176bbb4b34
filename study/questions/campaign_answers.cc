#include "study/questions/campaign_answers.h"

namespace gauntlet {

Result<CampaignAnswers> ReadAnswers(const std::string& dir) {
  CampaignAnswers answers;
  TRY(answers.confirmations, ReadConfirmations(dir));
  TRY(answers.smallest_layouts, ReadSmallestLayouts(dir));
  return answers;
}

}  // namespace gauntlet
