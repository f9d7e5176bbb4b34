// What a study has found, as text, Markdown and JSON.
#pragma once

#include <string>

#include "study/study_report.h"

namespace gauntlet {

std::string StudyText(const StudyReport& report);
// A page: the claims first, then every analysis with the published rows beside ours.
std::string StudyMarkdown(const StudyReport& report);
// {study, claims: [{analysis, claim, holds}], results: [{section, quantity, condition, published, ours,
// verdict, note, analysis}], figures: {NAME: number or text}, parts: [...],
// tunings: [...]}.
std::string StudyJson(const StudyReport& report, const std::string& directory);

}  // namespace gauntlet
