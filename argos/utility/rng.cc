#include <argos3/core/utility/math/rng.h>

#include <cmath>

namespace argos {
namespace {

constexpr UInt32 kLargest = std::numeric_limits<UInt32>::max();

}  // namespace

Real CRandom::CRNG::Share() {
  return static_cast<Real>(Next()) / static_cast<Real>(kLargest);
}

bool CRandom::CRNG::Bernoulli(Real probability) {
  return static_cast<Real>(Next()) < probability * static_cast<Real>(kLargest);
}

CRadians CRandom::CRNG::Uniform(const CRange<CRadians>& range) {
  return range.GetMin() + Share() * range.GetSpan();
}

Real CRandom::CRNG::Uniform(const CRange<Real>& range) {
  return range.GetMin() + Share() * range.GetSpan();
}

SInt32 CRandom::CRNG::Uniform(const CRange<SInt32>& range) {
  const Real min = range.GetMin();
  return static_cast<SInt32>(min + Share() * (static_cast<Real>(range.GetMax()) - min));
}

UInt32 CRandom::CRNG::Uniform(const CRange<UInt32>& range) {
  return static_cast<UInt32>(range.GetMin() + Share() * range.GetSpan());
}

Real CRandom::CRNG::Exponential(Real mean) {
  return -reproducible::Logarithm(Share()) * mean;
}

Real CRandom::CRNG::Gaussian(Real standard_deviation, Real mean) {
  while (true) {  // the polar method, of whose pair the first is taken
    const Real x = 2.0 * Share() - 1.0;
    const Real y = 2.0 * Share() - 1.0;
    const Real square = x * x + y * y;
    if (square >= 1.0 || square == 0.0) continue;
    return mean + standard_deviation * x * std::sqrt(-2.0 * reproducible::Logarithm(square) / square);
  }
}

Real CRandom::CRNG::Rayleigh(Real sigma) {
  return sigma * std::sqrt(-2.0 * reproducible::Logarithm(Share()));
}

Real CRandom::CRNG::Lognormal(Real sigma, Real mu) {
  return reproducible::Exponential(Gaussian(sigma, mu));
}

UInt32 CRandom::CRNG::Poisson(Real mean) {
  const Real enough = reproducible::Exponential(-mean);
  UInt32 events = 0;
  for (Real product = Share(); product > enough; product *= Share()) ++events;
  return events;
}

UInt32 CRandom::CCategory::NextSeed() {
  return seeder_.Uniform(CRange<UInt32>(1, kLargest));
}

CRandom::CRNG* CRandom::CCategory::CreateRNG() {
  return generators_.emplace_back(std::make_unique<CRNG>(NextSeed())).get();
}

void CRandom::CCategory::ResetRNGs() {
  seeder_.Reset();
  for (const std::unique_ptr<CRNG>& generator : generators_) {
    generator->SetSeed(NextSeed());
    generator->Reset();
  }
}

std::map<std::string, CRandom::CCategory>& CRandom::Categories() {
  static std::map<std::string, CCategory> categories;
  return categories;
}

bool CRandom::CreateCategory(const std::string& category, UInt32 seed) {
  return Categories().try_emplace(category, category, seed).second;
}

bool CRandom::ExistsCategory(const std::string& category) {
  return Categories().count(category) > 0;
}

CRandom::CCategory& CRandom::GetCategory(const std::string& category) {
  const auto found = Categories().find(category);
  if (found == Categories().end()) {
    throw CARGoSException("There is no category of random numbers \"" + category +
                          "\"; controllers use \"argos\"");
  }
  return found->second;
}

void CRandom::RemoveCategory(const std::string& category) {
  Categories().erase(category);
}

void CRandom::Reset() {
  for (auto& [name, category] : Categories()) category.ResetRNGs();
}

}  // namespace argos
