// A fit as people and programs are told it.
#pragma once

#include <string>
#include <vector>

#include "analysis/tables/section.h"
#include "study/fits/fit_result.h"

namespace gauntlet {

// Whether the chosen setting meets the targets, or why there is none: a sentence.
std::string OutcomeOf(const FitResult& fit);
// Settings, then targets. `program`: how commands begin.
std::vector<Section> TellFit(const FitResult& fit, const std::string& dir, const std::string& program);
std::string FitJson(const FitResult& fit, const std::string& dir);

}  // namespace gauntlet
