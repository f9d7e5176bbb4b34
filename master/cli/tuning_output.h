// What a tuning has found, as JSON and as pictures; its tables and sentences are those of its study's
// section.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "master/study/study_report.h"

namespace gauntlet::master {

// {analysis, parameters: [{key, baseline, recommended, evidence, values: [...]}], consistency: [{repeats,
// median_a, max_a}], enough, enough_in_words, p_by}. Of a section with a tuning.
nlohmann::ordered_json TuningJson(const StudySection& section);

// SVG documents by their names: "robustness", and "consistency" where that was computed.
std::vector<std::pair<std::string, std::string>> TuningPictures(const StudySection& section);

}  // namespace gauntlet::master
