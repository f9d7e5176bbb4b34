// All questions about cases. A new one is a file with its row, and a line here.
#pragma once

#include "study/questions/question.h"

namespace gauntlet {

Question EvaluateQuestion();
Question BaselineQuestion();
Question ConfirmQuestion();
Question MinimiseQuestion();
Question BlameQuestion();
Question CheckQuestion();
Question ControllerQuestion();

// In the order of `gauntlet --help`.
inline constexpr Question (*kQuestions[])() = {EvaluateQuestion,  BaselineQuestion, ConfirmQuestion,
                                               MinimiseQuestion,  BlameQuestion,    CheckQuestion,
                                               ControllerQuestion};

}  // namespace gauntlet
