#include "search/probability/splitting.h"

#include <algorithm>
#include <limits>

#include "base/check.h"

namespace gauntlet {
namespace {

constexpr double kFailed = -std::numeric_limits<double>::infinity();

}  // namespace

Splitting::Splitting(std::size_t particles, sim::RandomStream random)
    : particles_(particles), random_(random) {
  GAUNTLET_CHECK(particles >= kGivenUp, std::to_string(particles));
}

std::vector<SplittingRun> Splitting::Next() {
  std::vector<SplittingRun> runs;
  told_ = 0;
  if (AtEnd()) return runs;
  if (!begun_) {
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      moving_.push_back(i);
      runs.push_back({i});
    }
  } else {
    for (const std::size_t i : moving_) runs.push_back({i, particles_[i].sample});
  }
  return runs;
}

void Splitting::Tell(const SplittingRun& run, std::uint64_t sample, double score, bool failed) {
  const double held = failed ? kFailed : score;
  Particle& particle = particles_[run.particle];
  if (!begun_ || held < level_) particle = {sample, held};
  if (++told_ < moving_.size()) return;
  if (begun_ && --steps_left_ > 0) return;
  begun_ = true;
  BeginStage();
}

void Splitting::BeginStage() {
  std::vector<double> scores;
  for (const Particle& one : particles_) scores.push_back(one.score);
  const std::size_t given_up = particles_.size() / kGivenUp;
  std::ranges::nth_element(scores, scores.end() - static_cast<std::ptrdiff_t>(given_up));
  level_ = scores[scores.size() - given_up];
  std::vector<std::size_t> staying;
  moving_.clear();
  for (std::size_t i = 0; i < particles_.size(); ++i)
    (particles_[i].score < level_ ? staying : moving_).push_back(i);
  const auto all = static_cast<double>(particles_.size());
  if (level_ == kFailed) {  // fewer than a tenth are left that did not fail
    estimate_ =
        reached_ * static_cast<double>(std::ranges::count(particles_, kFailed, &Particle::score)) / all;
    return;
  }
  reached_ *= static_cast<double>(staying.size()) / all;
  if (staying.empty()) {
    estimate_ = 0.0;
    return;
  }
  for (const std::size_t i : moving_)
    particles_[i] = particles_[staying[random_.Below(static_cast<std::uint32_t>(staying.size()))]];
  steps_left_ = kSteps;
}

std::vector<std::uint64_t> Splitting::Failing() const {
  std::vector<std::uint64_t> samples;
  for (const Particle& one : particles_) {
    if (one.score == kFailed) samples.push_back(one.sample);
  }
  return samples;
}

}  // namespace gauntlet
