// Taylor series of sine, cosine and arctangent and the reduction of angles to where they hold: what
// trigonometry.cc and directions.cc compute with, so that both give the same bits.
#pragma once

#include <cmath>

namespace gauntlet::sim::series {

// Every polynomial below is a truncated Taylor series; the comment beside it states the first omitted term at
// the end of the reduced interval. Parentheses fix the order of every sum, so no compiler may choose one.

// pi/2 = A + B + C (reduction after Cody and Waite 1980): A and B have at most 33 significant bits, so that
// n * A and n * B are exact for n < 2^20; A + B + C is right to 2^-119.
inline constexpr double kHalfPiA = 0x1.921fb544p+0;
inline constexpr double kHalfPiB = 0x1.0b4611a6p-34;
inline constexpr double kHalfPiC = 0x1.3198a2e037073p-69;
inline constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;

// angle = quadrant * pi/2 + remainder, |remainder| <= pi/4 (up to rounding); the quadrant is a whole number.
struct Reduced {
  double remainder;
  double quadrant;
};

inline Reduced ReduceToOctant(double angle) {
  const double n = std::floor(angle * kTwoOverPi + 0.5);
  return {((angle - n * kHalfPiA) - n * kHalfPiB) - n * kHalfPiC, n};
}

// c[0] + c[1] z + ... + c[6] z^6.
inline double SevenTerms(const double (&c)[7], double z) {
  const double z2 = z * z;
  const double low = (c[0] + c[1] * z) + (c[2] + c[3] * z) * z2;
  const double high = (c[4] + c[5] * z) + c[6] * z2;
  return low + high * (z2 * z2);
}

// sin r for |r| <= pi/4; the first omitted term, r^17 / 17!, is below 5e-17.
inline double Sine(double r) {
  constexpr double c[] = {-1.0 / 6.0,        1.0 / 120.0,        -1.0 / 5040.0,         1.0 / 362880.0,
                          -1.0 / 39916800.0, 1.0 / 6227020800.0, -1.0 / 1307674368000.0};
  const double z = r * r;
  return r + (r * z) * SevenTerms(c, z);
}

// cos r for |r| <= pi/4; the first omitted term, r^18 / 18!, is below 3e-18.
inline double Cosine(double r) {
  constexpr double c[] = {1.0 / 24.0,        -1.0 / 720.0,         1.0 / 40320.0,         -1.0 / 3628800.0,
                          1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0};
  const double z = r * r;
  return (1.0 - 0.5 * z) + (z * z) * SevenTerms(c, z);
}

// atan u for |u| <= 1/8; the first omitted term, u^17 / 17, is below 3e-17.
inline double Arctangent(double u) {
  constexpr double c[] = {-1.0 / 3.0, 1.0 / 5.0, -1.0 / 7.0, 1.0 / 9.0, -1.0 / 11.0, 1.0 / 13.0, -1.0 / 15.0};
  const double z = u * u;
  return u + (u * z) * SevenTerms(c, z);
}

// atan t = atan c + atan((t - c) / (1 + t c)) with c the nearest of 0, 1/4, 1/2, 3/4, 1 to t in [0, 1], hence
// |(t - c) / (1 + t c)| <= 1/8. The arctangents of those.
inline constexpr double kArctangentOfQuarters[5] = {0.0, 0.24497866312686414, 0.4636476090008061,
                                                    0.6435011087932844, 0.78539816339744831};

// Lengths between which the steps of an arctangent neither overflow nor underflow.
inline constexpr double kShortest = 1e-290;
inline constexpr double kLongest = 1e290;

}  // namespace gauntlet::sim::series
