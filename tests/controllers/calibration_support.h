// What the calibration programs share: runs in the empty arena and in random valid cases.
#pragma once

#include <string_view>
#include <vector>

#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::calibration {

struct Amounts {
  int seeds = 100;  // of the empty arena
  int cases = 200;  // random ones
  int first = 0;    // number of the first case and seed
  int genes = 8;
  double l_max = 2.0;  // m, longest obstacle
};

struct Specs {
  std::vector<sim::RunSpec> empty;
  std::vector<sim::RunSpec> random;
};

// Copies of `spec` with seeds and cases. Genes are redrawn one by one until valid.
Specs MakeSpecs(const sim::RunSpec& spec, const Amounts& amounts);

// In the order of the specs, each with its CPU time.
std::vector<sim::RunResult> RunAll(const std::vector<sim::RunSpec>& specs, int threads);

// 0 when the result has no such metric.
double Metric(const sim::RunResult& result, std::string_view name);

}  // namespace gauntlet::calibration
