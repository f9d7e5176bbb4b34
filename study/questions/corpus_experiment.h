// The experiment that a case of a corpus belongs to, as settings in the case's file.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "search/cases/corpus_file.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

// Everything of an experiment that a run of a given case depends on, as --set takes it.
std::vector<std::pair<std::string, std::string>> SettingsOf(const Experiment& experiment);

// The experiment of a case, with `sets` ("key=value") instead of what its file says; with another controller
// the file's controller_parameters are left out. Error: a setting is refused, is of another scenario, or the
// case breaks a rule. `plugins`: the SHA-256 of those that may bring the controller.
Result<Experiment> ExperimentOf(const CorpusEntry& entry, const std::vector<std::string>& sets,
                                const std::vector<std::string>& plugins);

}  // namespace gauntlet
