// Tails and quantiles of distributions: the one door to Boost.Math. Pure functions; an argument outside the
// stated range is a defect of the caller.
#pragma once

namespace gauntlet::analysis {

// P(Z > z) of the standard normal distribution.
double NormalUpperTail(double z);
// The z with P(Z <= z) = `probability` in (0, 1).
double NormalQuantile(double probability);

// P(T > t) of Student's t distribution; any degrees of freedom > 0.
double StudentUpperTail(double t, double degrees_of_freedom);
// The t with P(T > t) = `tail` in (0, 1).
double StudentUpperQuantile(double tail, double degrees_of_freedom);

}  // namespace gauntlet::analysis
