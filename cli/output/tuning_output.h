// What a tuning has found, as JSON; its tables, sentences and figures are those of its study's section.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "study/study_report.h"

namespace gauntlet {

// {analysis, parameters: [{key, baseline, recommended, evidence, values: [...]}], consistency: [{repeats,
// median_a, max_a}], enough, enough_in_words, p_by}. Of a section with a tuning.
nlohmann::ordered_json TuningJson(const StudySection& section);

}  // namespace gauntlet
