// Random numbers, the same streams as ARGoS' from the same seed.
#pragma once

#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/general.h>
#include <argos3/core/utility/math/range.h>

namespace argos {

// Generators belong to categories. A category seeds them in the order of their creation; controllers use
// "argos", which every run seeds anew.
class CRandom {
 public:
  // MT19937. A draw takes one number of 32 bits, unless it says otherwise.
  class CRNG {
   public:
    explicit CRNG(UInt32 seed) : seed_(seed), engine_(seed) {}

    UInt32 GetSeed() const { return seed_; }
    void SetSeed(UInt32 seed) { seed_ = seed; }  // from the next Reset on
    void Reset() { engine_.seed(seed_); }

    bool Bernoulli(Real probability = 0.5);
    CRadians Uniform(const CRange<CRadians>& range);  // both ends may come
    Real Uniform(const CRange<Real>& range);          // both ends may come
    // Towards zero: of a range across zero the minimum does not come, and 0 twice as often.
    SInt32 Uniform(const CRange<SInt32>& range);
    UInt32 Uniform(const CRange<UInt32>& range);  // in practice without the maximum
    Real Exponential(Real mean);
    Real Gaussian(Real standard_deviation, Real mean = 0.0);  // two numbers or more
    Real Rayleigh(Real sigma);
    Real Lognormal(Real sigma, Real mu);
    UInt32 Poisson(Real mean);
    template <typename T>
    void Shuffle(std::vector<T>& values) {
      for (UInt32 i = 0; i + 1 < values.size(); ++i) {
        const auto left = static_cast<UInt32>(values.size()) - i;
        std::swap(values[i], values[i + Uniform(CRange<UInt32>(0, left))]);
      }
    }

   private:
    UInt32 Next() { return static_cast<UInt32>(engine_()); }
    Real Share();  // in [0, 1]

    UInt32 seed_;
    std::mt19937 engine_;
  };

  class CCategory {
   public:
    CCategory(std::string id, UInt32 seed) : id_(std::move(id)), seeder_(seed) {}

    const std::string& GetId() const { return id_; }
    UInt32 GetSeed() const { return seeder_.GetSeed(); }
    void SetSeed(UInt32 seed) { seeder_.SetSeed(seed); }
    // The category owns it.
    CRNG* CreateRNG();
    // Gives every generator its seed again, in the order of their creation, and resets it.
    void ResetRNGs();

   private:
    UInt32 NextSeed();

    std::string id_;
    CRNG seeder_;
    std::vector<std::unique_ptr<CRNG>> generators_;
  };

  // Of an unknown category these throw; a category that exists is not created again.
  static CRNG* CreateRNG(const std::string& category) { return GetCategory(category).CreateRNG(); }
  static bool CreateCategory(const std::string& category, UInt32 seed);
  static bool ExistsCategory(const std::string& category);
  static CCategory& GetCategory(const std::string& category);
  static void RemoveCategory(const std::string& category);
  static UInt32 GetSeedOf(const std::string& category) { return GetCategory(category).GetSeed(); }
  static void SetSeedOf(const std::string& category, UInt32 seed) { GetCategory(category).SetSeed(seed); }
  static void Reset();

 private:
  static std::map<std::string, CCategory>& Categories();
};

}  // namespace argos
