// A run that was simulated again, as pictures of it are made.
#pragma once

#include <string>

#include "analysis/figures/run/run_figure.h"
#include "controllers/behaviour.h"
#include "master/campaign/replay.h"

namespace gauntlet {

// A metric's value for people: angles in degrees; a metric that the scenario does not describe (nullptr) is
// its bare number.
std::string MetricText(const controllers::MetricInfo* info, double value);

// `report` without damage. The style is that of the run's scenario.
analysis::RunFigure FigureOf(const std::string& experiment_name, const ReplayReport& report);

}  // namespace gauntlet
