#include "search/probability/conditions.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

// Of a step: how far the scores move, and the share of the genes that change. Chosen on a smooth toy with
// four conditions: of .3, .5 and .7 the last has the smallest variance for the same runs.
constexpr double kMove = 0.7;
constexpr double kChangedGenes = 0.25;

// The probability that a standard normal value lies below z (Abramowitz and Stegun 26.2.17), to 7.5e-8.
double NormalShare(double z) {
  if (z > 0.0) return 1.0 - NormalShare(-z);
  constexpr double kDensity = 0.3989422804014327;
  const double t = 1.0 / (1.0 - 0.2316419 * z);
  const double series =
      t * (0.319381530 + t * (-0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429))));
  return kDensity * sim::Exp(-z * z / 2.0) * series;
}

// Of experiment.probability.weights, which sum to 1.
Result<std::vector<double>> WeightsOf(const std::string& text, std::size_t cases) {
  constexpr const char* kKey = "probability.weights";
  std::vector<double> weights;
  double sum = 0.0;
  for (const std::string& word : WordsOf(text)) {
    const auto weight = ParseNumber<double>(word);
    if (!weight || !std::isfinite(*weight) || *weight < 0.0)
      return InvalidInput(fmt::format("{} = \"{}\": '{}' is no number from 0 on", kKey, text, word));
    weights.push_back(*weight);
    sum += *weight;
  }
  if (weights.empty()) return std::vector<double>(cases, 1.0 / static_cast<double>(cases));
  if (weights.size() != cases) {
    return InvalidInput(fmt::format("{} = \"{}\": {} for {}: one for each is needed", kKey, text,
                                    Counted(weights.size(), "weight"), Counted(cases, "given case")));
  }
  if (sum <= 0.0) return InvalidInput(fmt::format("{} = \"{}\": the weights sum to nothing", kKey, text));
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

Conditions::Conditions(const SearchSetup& setup, std::vector<VariedKey> varied, std::vector<double> weights)
    : varied_(std::move(varied)),
      cases_(setup.cases),
      weights_(std::move(weights)),
      generates_(cases_.size() == 1 && cases_.front().obstacles.empty() && setup.experiment.genome.genes > 0),
      generator_(MakeGenerator(setup)) {}

Result<Conditions> Conditions::Make(const SearchSetup& setup, std::span<const Key> keys) {
  if (setup.cases.empty()) return InvalidInput("no case is given: gauntlet probability makes such a search");
  TRY(std::vector<VariedKey> varied,
      ParseVariedKeys(WordsOf(setup.experiment.conditions), keys, setup.experiment, Varied::kDrawn));
  for (const VariedKey& one : varied) {
    if (one.key.path.starts_with("genome.") || one.key.path.starts_with("arena."))
      return InvalidInput(
          fmt::format("[conditions] {}: arenas are drawn from the ranges of [genome] in that of "
                      "[arena], or given by --on",
                      one.key.path));
  }
  TRY(std::vector<double> weights, WeightsOf(setup.experiment.probability.weights, setup.cases.size()));
  Conditions conditions(setup, std::move(varied), std::move(weights));
  if (conditions.size() == 0)
    return InvalidInput("nothing varies: give [conditions], generated arenas or several cases");
  if (conditions.generates_) {
    constexpr std::uint64_t kTrials = 20;
    for (std::uint64_t i = 1; i <= kTrials; ++i) {
      sim::RandomStream random(i, sim::StreamPurpose::kGenome);
      TRY(conditions.generator_.RandomTestCase(random));
    }
  }
  return conditions;
}

std::size_t Conditions::size() const {
  const auto genes = static_cast<std::size_t>(generator_.spec().genes);
  return varied_.size() + (generates_ ? genes : 0) + (cases_.size() > 1 ? 1 : 0);
}

Sample Conditions::Draw(sim::RandomStream random) const {
  Sample sample;
  for (std::size_t i = 0; i < varied_.size(); ++i) sample.scores.push_back(random.Gaussian());
  for (int i = 0; generates_ && i < generator_.spec().genes; ++i)
    sample.genes.push_back(generator_.DrawGene(random));
  double left = random.Uniform();
  while (sample.of_case + 1 < cases_.size() && left >= weights_[sample.of_case])
    left -= weights_[sample.of_case++];
  return sample;
}

Sample Conditions::Near(Sample sample, sim::RandomStream random) const {
  const Sample fresh = Draw({random.NextUint64(), sim::StreamPurpose::kGenome});
  const double stays = std::sqrt(1.0 - kMove * kMove);
  for (std::size_t i = 0; i < sample.scores.size(); ++i)
    sample.scores[i] = stays * sample.scores[i] + kMove * fresh.scores[i];
  for (std::size_t i = 0; i < sample.genes.size(); ++i) {
    if (!random.Chance(kChangedGenes)) continue;
    if (random.Chance(0.5)) {
      sample.genes[i] = fresh.genes[i];
    } else {
      sample.genes[i].first = generator_.NearGene(std::move(sample.genes[i].first), kChangedGenes, random);
    }
  }
  if (random.Chance(kChangedGenes)) sample.of_case = fresh.of_case;
  return sample;
}

std::vector<KeyValue> Conditions::ValuesOf(const Sample& sample) const {
  std::vector<KeyValue> values;
  for (std::size_t i = 0; i < varied_.size(); ++i)
    values.push_back(varied_[i].ValueAt(NormalShare(sample.scores[i])));
  return values;
}

sim::TestCase Conditions::CaseOf(const Sample& sample) const {
  if (!generates_) return cases_[sample.of_case];
  Result<sim::TestCase> drawn = generator_.CaseOf(sample.genes);
  // Make has seen that the ranges leave room.
  sim::RandomStream again(sample.genes.front().others, sim::StreamPurpose::kGenome, /*a=*/2);
  while (!drawn) drawn = generator_.RandomTestCase(again);
  return *std::move(drawn);
}

double Conditions::DensityOf(const Sample& sample) const {
  double density = weights_[sample.of_case] / *std::ranges::max_element(weights_);
  for (std::size_t i = 0; i < varied_.size(); ++i)
    density *= varied_[i].DensityAt(NormalShare(sample.scores[i]));
  return density;
}

}  // namespace gauntlet
