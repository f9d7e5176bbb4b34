#include "search/fit/posterior.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "analysis/statistics/sample.h"
#include "base/check.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

using Demand = FitTarget::Demand;

constexpr double kNever = -1e30;  // a logarithm
constexpr int kResamples = 200;
constexpr std::size_t kNeighbours = 12;
constexpr double kKeepShare = 0.5;   // of the population that counts after a step of the temperature
constexpr int kMoves = 4;            // of each draw at each temperature
constexpr double kFreshShare = 0.2;  // of the moves that draw one place anew
constexpr int kMostTries = 200;      // to find an allowed place

std::size_t ComponentsOf(const FitTarget& target) {
  return target.values.size();
}

// The standard normal distribution function (Abramowitz and Stegun 1964, 26.2.17; error below 1e-7), as a
// logarithm; by its asymptotic form far below.
double LogNormalCdf(double z) {
  if (z < -5.0) return -0.5 * z * z - sim::Log(-z * std::sqrt(2.0 * sim::kPi)) - 1.0 / (z * z);
  const double t = 1.0 / (1.0 + 0.2316419 * std::abs(z));
  const double poly =
      t * (0.319381530 + t * (-0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429))));
  const double tail = sim::Exp(-0.5 * z * z) / std::sqrt(2.0 * sim::kPi) * poly;
  return sim::Log(z < 0.0 ? tail : 1.0 - tail);
}

// r' S^-1 r and log |S|, of a positive definite S.
struct Quadratic {
  double form = 0.0;
  double log_determinant = 0.0;
};
std::optional<Quadratic> QuadraticOf(Eigen::MatrixXd matrix, Eigen::VectorXd r) {
  if (!Cholesky(matrix)) return std::nullopt;
  SolveLower(matrix, r);
  Quadratic result;
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    result.form += Squared(r(i));
    result.log_determinant += 2.0 * sim::Log(matrix(i, i));
  }
  return result;
}

// A variance that no finite sample of few different values shows: of zeros and ones that of half a run more
// of each, of other numbers what two runs more do that are as far apart as the others.
double LeastVariance(const std::vector<double>& values) {
  std::vector<double> measured = values;
  std::erase_if(measured, [](double value) { return !std::isfinite(value); });
  if (measured.size() < 2) return 0.0;
  const auto runs = static_cast<double>(measured.size());
  const analysis::Description all = analysis::Describe(measured);
  if (std::ranges::all_of(measured, [](double value) { return value == 0.0 || value == 1.0; })) {
    const double share = (all.mean * runs + 0.5) / (runs + 1.0);
    return share * (1.0 - share);
  }
  return 2.0 * Squared(*all.sd) / (runs + 1.0);
}

bool SameRuns(const FitTarget& a, const FitTarget& b) {
  return a.cases == b.cases;
}

}  // namespace

SettingStatistics StatisticsOf(SettingsPoint place, std::span<const FitTarget> targets,
                               const std::vector<std::vector<double>>& values, sim::RandomStream random) {
  SettingStatistics statistics{.place = std::move(place)};
  std::vector<std::size_t> target_of;  // [component]
  for (std::size_t t = 0; t < targets.size(); ++t) {
    std::vector<double> ours = StatisticOf(targets[t], values[t]);
    ours.resize(ComponentsOf(targets[t]), kNotMeasured);
    statistics.values.insert(statistics.values.end(), ours.begin(), ours.end());
    statistics.runs.insert(statistics.runs.end(), ours.size(), static_cast<double>(values[t].size()));
    target_of.insert(target_of.end(), ours.size(), t);
  }
  const auto n = std::ssize(target_of);
  statistics.covariance = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd resampled(n, kResamples);
  for (int sample = 0; sample < kResamples; ++sample) {
    std::vector<std::vector<std::uint32_t>> chosen(targets.size());
    Eigen::Index row = 0;
    for (std::size_t t = 0; t < targets.size(); ++t) {
      for (std::size_t before = 0; before < t && chosen[t].empty(); ++before) {
        if (SameRuns(targets[before], targets[t])) chosen[t] = chosen[before];
      }
      const auto count = static_cast<std::uint32_t>(values[t].size());
      while (chosen[t].size() < count) chosen[t].push_back(random.Below(count));
      std::vector<double> drawn;
      for (const std::uint32_t run : chosen[t]) drawn.push_back(values[t][run]);
      std::vector<double> ours = StatisticOf(targets[t], std::move(drawn));
      ours.resize(ComponentsOf(targets[t]), kNotMeasured);
      for (const double number : ours) {
        const double known = statistics.values[static_cast<std::size_t>(row)];
        resampled(row++, sample) = std::isfinite(number) ? number : known;
      }
    }
  }
  for (Eigen::Index a = 0; a < n; ++a) {
    const auto at = static_cast<std::size_t>(a);
    const FitTarget& target = targets[target_of[at]];
    for (Eigen::Index b = 0; b <= a; ++b) {
      const auto other = static_cast<std::size_t>(b);
      // Runs of different cases know nothing of each other.
      if (!SameRuns(target, targets[target_of[other]])) continue;
      double sum_a = 0.0;
      double sum_b = 0.0;
      double product = 0.0;
      for (int sample = 0; sample < kResamples; ++sample) {
        sum_a += resampled(a, sample);
        sum_b += resampled(b, sample);
        product += resampled(a, sample) * resampled(b, sample);
      }
      const double covariance = (product - sum_a * sum_b / kResamples) / (kResamples - 1);
      statistics.covariance(a, b) = statistics.covariance(b, a) =
          covariance * std::sqrt(statistics.runs[at] * statistics.runs[other]);
    }
    double& variance = statistics.covariance(a, a);
    variance = std::max(variance, LeastVariance(values[target_of[at]]));
  }
  return statistics;
}

bool SettingStatistics::Whole() const {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

double MisfitOf(const FitTarget& target, std::span<const double> ours, const Eigen::MatrixXd& covariance) {
  const auto n = static_cast<Eigen::Index>(ours.size());
  if (std::ranges::any_of(ours, [](double value) { return !std::isfinite(value); }))
    return std::numeric_limits<double>::infinity();
  if (target.demand == Demand::kEvery) {
    const double share = std::clamp(ours[0], 1e-9, 1.0);
    return std::sqrt(std::max(0.0, -2.0 * target.n * sim::Log(share)));
  }
  Eigen::VectorXd difference(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    difference(i) = ours[at] - target.values[at];
  }
  if (target.demand != Demand::kEquals) {
    const double beyond = target.demand == Demand::kAtMost ? difference(0) : -difference(0);
    return beyond <= 0.0 ? 0.0 : beyond / std::sqrt(covariance(0, 0) + 1e-300);
  }
  Eigen::MatrixXd safe = covariance;
  for (Eigen::Index i = 0; i < n; ++i)
    safe(i, i) += 1e-9 * (covariance(i, i) + Squared(target.values[static_cast<std::size_t>(i)])) + 1e-300;
  const auto quadratic = QuadraticOf(safe, difference);
  return quadratic ? std::sqrt(quadratic->form / static_cast<double>(n))
                   : std::numeric_limits<double>::infinity();
}

FitPosterior::FitPosterior(std::span<const VariedKey> varied, std::span<const FitTarget> targets,
                           std::span<const SettingStatistics> settings)
    : varied_(varied), targets_(targets) {
  for (std::size_t t = 0; t < targets.size(); ++t) {
    parts_.push_back({target_of_.size(), ComponentsOf(targets[t])});
    target_of_.insert(target_of_.end(), ComponentsOf(targets[t]), t);
  }
  std::vector<const SettingStatistics*> whole;
  for (const SettingStatistics& one : settings) {
    if (one.Whole()) whole.push_back(&one);
  }
  GAUNTLET_CHECK(whole.size() >= 2, "too few settings");
  const auto n = static_cast<Eigen::Index>(whole.size());
  inputs_.resize(InputOf(whole.front()->place).size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const SettingStatistics& one = *whole[static_cast<std::size_t>(i)];
    inputs_.col(i) = InputOf(one.place);
    covariances_.push_back(one.covariance);
  }
  std::vector<Eigen::MatrixXd> near;
  for (Eigen::Index i = 0; i < n; ++i) near.push_back(CovarianceNear(inputs_.col(i)));
  for (std::size_t c = 0; c < target_of_.size(); ++c) {
    std::vector<double> values;
    std::vector<double> noise;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(c);
      values.push_back(whole[i]->values[c]);
      noise.push_back(near[i](row, row) / whole[i]->runs[c]);
    }
    emulators_.emplace_back(inputs_, values, noise);
  }
}

Eigen::VectorXd FitPosterior::InputOf(const SettingsPoint& place) const {
  std::vector<double> input;
  for (std::size_t i = 0; i < varied_.size(); ++i) {
    const VariedKey& key = varied_[i];
    const double realised = key.PlaceOf(key.ValueAt(place[i]));
    const std::size_t count = key.values.size();
    if (count <= 2) {
      input.push_back(count == 2 ? (realised > 0.5 ? 1.0 : 0.0) : realised);
      continue;
    }
    // No value of a list is nearer to one than to another.
    const auto chosen = static_cast<std::size_t>(realised * static_cast<double>(count));
    for (std::size_t j = 0; j < count; ++j) input.push_back(j == chosen ? 1.0 : 0.0);
  }
  return Eigen::Map<const Eigen::VectorXd>(input.data(), std::ssize(input));
}

Eigen::MatrixXd FitPosterior::CovarianceNear(const Eigen::VectorXd& input) const {
  std::vector<std::pair<double, Eigen::Index>> distances;
  for (Eigen::Index i = 0; i < inputs_.cols(); ++i) {
    double squared = 0.0;
    for (Eigen::Index d = 0; d < input.size(); ++d) squared += Squared(inputs_(d, i) - input(d));
    distances.emplace_back(squared, i);
  }
  const std::size_t count = std::min(kNeighbours, distances.size());
  std::ranges::nth_element(distances, distances.begin() + static_cast<std::ptrdiff_t>(count) - 1);
  std::sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(count));
  const auto components = static_cast<Eigen::Index>(target_of_.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(components, components);
  for (std::size_t i = 0; i < count; ++i) sum += covariances_[static_cast<std::size_t>(distances[i].second)];
  return sum / static_cast<double>(count);
}

void FitPosterior::Predict(const SettingsPoint& place, std::span<const std::size_t> only,
                           Eigen::VectorXd& mean, Eigen::MatrixXd& unsure,
                           Eigen::MatrixXd& covariance) const {
  const Eigen::VectorXd input = InputOf(place);
  covariance = CovarianceNear(input);
  mean = Eigen::VectorXd::Zero(std::ssize(emulators_));
  Eigen::VectorXd variance = mean;
  for (Eigen::Index c = 0; c < mean.size(); ++c) {
    const std::size_t target = target_of_[static_cast<std::size_t>(c)];
    if (!only.empty() && std::ranges::find(only, target) == only.end()) continue;
    const Emulator::Prediction predicted = emulators_[static_cast<std::size_t>(c)].At(input);
    mean(c) = predicted.mean;
    variance(c) = predicted.variance;
  }
  // What emulators learnt from the same runs is wrong together, as those runs are.
  const Eigen::ArrayXd of_runs = covariance.diagonal();
  const Eigen::VectorXd scale = (of_runs > 0.0).select((variance.array() / of_runs).sqrt(), 0.0);
  unsure = scale.asDiagonal() * covariance * scale.asDiagonal();
  unsure.diagonal() = variance;
}

double FitPosterior::LogOfEqualities(std::span<const std::size_t> targets, const Eigen::VectorXd& mean,
                                     const Eigen::MatrixXd& unsure, const Eigen::MatrixXd& covariance) const {
  std::vector<Eigen::Index> components;
  std::vector<double> wanted;
  for (const std::size_t t : targets) {
    for (std::size_t i = 0; i < parts_[t].count; ++i) {
      components.push_back(static_cast<Eigen::Index>(parts_[t].begin + i));
      wanted.push_back(targets_[t].values[i]);
    }
  }
  const auto n = static_cast<Eigen::Index>(components.size());
  if (n == 0) return 0.0;
  Eigen::MatrixXd total(n, n);
  Eigen::VectorXd difference(n);
  for (Eigen::Index a = 0; a < n; ++a) {
    const Eigen::Index row = components[static_cast<std::size_t>(a)];
    difference(a) = mean(row) - wanted[static_cast<std::size_t>(a)];
    for (Eigen::Index b = 0; b < n; ++b) {
      const Eigen::Index column = components[static_cast<std::size_t>(b)];
      // Of two samples of one set of runs the smaller is a part of the larger.
      const double runs = std::max(targets_[target_of_[static_cast<std::size_t>(row)]].n,
                                   targets_[target_of_[static_cast<std::size_t>(column)]].n);
      total(a, b) = covariance(row, column) / runs + unsure(row, column);
    }
    total(a, a) = total(a, a) * (1.0 + 1e-6) + 1e-300;
  }
  const auto quadratic = QuadraticOf(total, difference);
  return quadratic ? -0.5 * (quadratic->form + quadratic->log_determinant) : kNever;
}

double FitPosterior::LogLikelihood(const SettingsPoint& place, std::span<const std::size_t> only) const {
  Eigen::VectorXd mean;
  Eigen::MatrixXd unsure;
  Eigen::MatrixXd covariance;
  Predict(place, only, mean, unsure, covariance);
  std::vector<std::size_t> equalities;
  double log = 0.0;
  const auto add = [&](std::size_t t) {
    const FitTarget& target = targets_[t];
    if (target.demand == Demand::kEquals) return equalities.push_back(t);
    const auto row = static_cast<Eigen::Index>(parts_[t].begin);
    if (target.demand == Demand::kEvery) {
      log += target.n * sim::Log(std::clamp(mean(row), 1e-9, 1.0));
      return;
    }
    const double variance = unsure(row, row) + (target.n > 0.0 ? covariance(row, row) / target.n : 0.0);
    const double above = (mean(row) - target.values[0]) / std::sqrt(variance + 1e-300);
    log += LogNormalCdf(std::clamp(target.demand == Demand::kAtMost ? -above : above, -1e6, 1e6));
  };
  if (only.empty()) {
    for (std::size_t t = 0; t < targets_.size(); ++t) add(t);
  } else {
    for (const std::size_t t : only) add(t);
  }
  log += LogOfEqualities(equalities, mean, unsure, covariance);
  return std::isfinite(log) ? log : kNever;
}

double FitPosterior::Misfit(const SettingsPoint& place, std::size_t target) const {
  Eigen::VectorXd mean;
  Eigen::MatrixXd unsure;
  Eigen::MatrixXd covariance;
  Predict(place, {&target, 1}, mean, unsure, covariance);
  const Part& part = parts_[target];
  const auto begin = static_cast<Eigen::Index>(part.begin);
  const auto count = static_cast<Eigen::Index>(part.count);
  std::vector<double> ours;
  for (Eigen::Index i = 0; i < count; ++i) ours.push_back(mean(begin + i));
  const double n = targets_[target].n;
  const Eigen::MatrixXd total =
      (covariance / (n > 0.0 ? n : 1e300) + unsure).block(begin, begin, count, count);
  return MisfitOf(targets_[target], ours, total);
}

std::vector<double> FitPosterior::ExpectedAt(const SettingsPoint& place) const {
  const Eigen::VectorXd input = InputOf(place);
  std::vector<double> expected;
  for (const Emulator& emulator : emulators_) expected.push_back(emulator.At(input).mean);
  return expected;
}

namespace {

struct Particle {
  SettingsPoint place;
  double log = 0.0;
};

SettingsPoint Anywhere(std::size_t dimensions, sim::RandomStream& random) {
  SettingsPoint place;
  for (std::size_t d = 0; d < dimensions; ++d) place.push_back(random.Uniform());
  return place;
}

// Back from a border of the range.
double Reflected(double place) {
  place = std::abs(place);
  place -= 2.0 * std::floor(place / 2.0);
  return std::min(place > 1.0 ? 2.0 - place : place, 1.0 - 1e-12);
}

// The largest step of the temperature after which `kKeepShare` of the particles still count.
double NextTemperature(std::span<const Particle> particles, double temperature) {
  const auto counting = [&](double step) {
    double highest = kNever;
    for (const Particle& one : particles) highest = std::max(highest, one.log);
    double sum = 0.0;
    double squares = 0.0;
    for (const Particle& one : particles) {
      const double weight = sim::Exp(std::max(step * (one.log - highest), -600.0));
      sum += weight;
      squares += weight * weight;
    }
    return sum * sum / squares;
  };
  const double enough = kKeepShare * static_cast<double>(particles.size());
  double high = 1.0 - temperature;
  if (counting(high) >= enough) return 1.0;
  double low = 0.0;
  for (int i = 0; i < 40; ++i) (counting((low + high) / 2.0) >= enough ? low : high) = (low + high) / 2.0;
  return temperature + std::max(low, 1e-9);
}

// Each particle as often as its weight says (Kitagawa 1996).
std::vector<Particle> Resampled(const std::vector<Particle>& particles, double step,
                                sim::RandomStream& random) {
  double highest = kNever;
  for (const Particle& one : particles) highest = std::max(highest, one.log);
  std::vector<double> sums;
  double sum = 0.0;
  for (const Particle& one : particles)
    sums.push_back(sum += sim::Exp(std::max(step * (one.log - highest), -600.0)));
  std::vector<Particle> chosen;
  const double spacing = sum / static_cast<double>(particles.size());
  double at = spacing * random.Uniform();
  for (std::size_t i = 0; chosen.size() < particles.size(); at += spacing) {
    while (i + 1 < sums.size() && sums[i] <= at) ++i;
    chosen.push_back(particles[i]);
  }
  return chosen;
}

}  // namespace

std::vector<SettingsPoint> FitPosterior::Draw(std::size_t count, const Allowed& allowed,
                                              sim::RandomStream& random,
                                              std::span<const std::size_t> only) const {
  const std::size_t dimensions = varied_.size();
  std::vector<Particle> particles;
  for (std::size_t i = 0; i < count; ++i) {
    int tries = 0;
    SettingsPoint place = Anywhere(dimensions, random);
    while (!allowed(place) && ++tries < kMostTries) place = Anywhere(dimensions, random);
    if (tries == kMostTries) return {};
    particles.push_back({place, LogLikelihood(place, only)});
  }
  const double usual = 2.38 / std::sqrt(2.0 * static_cast<double>(dimensions));
  const auto bound = static_cast<std::uint32_t>(count);
  for (double temperature = 0.0; temperature < 1.0;) {
    const double next = NextTemperature(particles, temperature);
    particles = Resampled(particles, next - temperature, random);
    temperature = next;
    for (int move = 0; move < kMoves; ++move) {
      const std::vector<Particle> others = particles;
      for (Particle& one : particles) {
        SettingsPoint place = one.place;
        if (random.Chance(kFreshShare)) {
          place[random.Below(static_cast<std::uint32_t>(dimensions))] = random.Uniform();
        } else {
          const SettingsPoint& a = others[random.Below(bound)].place;
          const SettingsPoint& b = others[random.Below(bound)].place;
          const double stride = random.Chance(0.1) ? 1.0 : usual * (0.5 + random.Uniform());
          for (std::size_t d = 0; d < dimensions; ++d)
            place[d] = Reflected(place[d] + stride * (a[d] - b[d]) + 1e-4 * (random.Uniform() - 0.5));
        }
        const double log = allowed(place) ? LogLikelihood(place, only) : kNever;
        const double gain = temperature * (log - one.log);
        if (gain >= 0.0 || random.Uniform() < sim::Exp(std::max(gain, -600.0))) one = {place, log};
      }
    }
  }
  std::vector<SettingsPoint> draws;
  for (Particle& one : particles) draws.push_back(std::move(one.place));
  return draws;
}

}  // namespace gauntlet
