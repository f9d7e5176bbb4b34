// Random numbers against those that ARGoS draws.
// Covers: argos/utility/rng.cc
#include <argos3/core/utility/math/rng.h>

#include <gtest/gtest.h>

#include <vector>

namespace argos {
namespace {

class RandomNumbers : public testing::Test {
 protected:
  void SetUp() override { CRandom::CreateCategory("test", 124); }
  void TearDown() override { CRandom::RemoveCategory("test"); }

  template <typename Draw>
  auto Draws(int count, const Draw& draw) {
    generator_->Reset();
    std::vector<decltype(draw(*generator_))> values;
    for (int i = 0; i < count; ++i) values.push_back(draw(*generator_));
    return values;
  }

  CRandom::CRNG* first() {
    if (generator_ == nullptr) generator_ = CRandom::CreateRNG("test");
    return generator_;
  }

  CRandom::CRNG* generator_ = nullptr;
};

TEST_F(RandomNumbers, SeedsOfGeneratorsFollowFromTheCategorys) {
  for (const UInt32 seed : {455545294u, 2996933276u, 3201775633u}) {
    EXPECT_EQ(CRandom::CreateRNG("test")->GetSeed(), seed);
  }
  CRandom::CreateCategory("other", 1);
  for (const UInt32 seed : {1791095845u, 4282876139u, 3093770124u}) {
    EXPECT_EQ(CRandom::CreateRNG("other")->GetSeed(), seed);
  }
  CRandom::RemoveCategory("other");
}

TEST_F(RandomNumbers, AreThoseOfArgos) {
  first();
  EXPECT_EQ(Draws(3, [](CRandom::CRNG& rng) { return rng.Uniform(CRange<Real>(0.0, 1.0)); }),
            (std::vector<Real>{0.19598282901476669, 0.1799239661032157, 0.80037195091144464}));
  EXPECT_EQ(Draws(8, [](CRandom::CRNG& rng) { return rng.Uniform(CRange<UInt32>(0, 10)); }),
            (std::vector<UInt32>{1, 1, 8, 9, 5, 9, 1, 3}));
  EXPECT_EQ(Draws(8, [](CRandom::CRNG& rng) { return rng.Uniform(CRange<SInt32>(-3, 3)); }),
            (std::vector<SInt32>{-1, -1, 1, 2, 0, 2, -2, 0}));
  EXPECT_EQ(Draws(12, [](CRandom::CRNG& rng) { return rng.Bernoulli(); }),
            (std::vector<bool>{true, true, false, false, false, false, true, true, true, true, false, true}));
  EXPECT_EQ(Draws(1, [](CRandom::CRNG& rng) { return rng.Uniform(CRadians::SIGNED_RANGE).GetValue(); }),
            (std::vector<Real>{-1.9101962218647219}));
  // By our own logarithm, which is right to the last bits.
  const auto gaussian = Draws(2, [](CRandom::CRNG& rng) { return rng.Gaussian(1.0); });
  EXPECT_NEAR(gaussian[0], -0.48609770106300687, 1e-14);
  EXPECT_NEAR(gaussian[1], 0.0018133956128921734, 1e-14);
  EXPECT_NEAR(Draws(1, [](CRandom::CRNG& rng) { return rng.Exponential(2.0); })[0], 3.2594564613137202,
              1e-13);
}

TEST_F(RandomNumbers, ComeAgainAfterAReset) {
  const Real before = first()->Uniform(CRange<Real>(0.0, 1.0));
  first()->Uniform(CRange<Real>(0.0, 1.0));
  CRandom::Reset();
  EXPECT_EQ(first()->Uniform(CRange<Real>(0.0, 1.0)), before);
}

TEST_F(RandomNumbers, ShuffleKeepsWhatIsThere) {
  std::vector<int> values = {1, 2, 3, 4, 5};
  first()->Shuffle(values);
  EXPECT_NE(values, (std::vector<int>{1, 2, 3, 4, 5}));
  std::sort(values.begin(), values.end());
  EXPECT_EQ(values, (std::vector<int>{1, 2, 3, 4, 5}));
}

TEST_F(RandomNumbers, OfAnUnknownCategoryAreRefused) {
  EXPECT_THROW(CRandom::CreateRNG("nobody"), CARGoSException);
}

}  // namespace
}  // namespace argos
