// Encodings, hashes and texts that stored data and users depend on.
// Covers: base/check.cc, base/number_text.cc
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/canonical_encoder.h"
#include "base/hash.h"
#include "base/mean_and_range.h"
#include "base/number_text.h"
#include "base/result.h"

namespace gauntlet {
namespace {

TEST(CanonicalEncoderTest, BytesAreLittleEndianWithLengthsInFront) {
  CanonicalEncoder encoder;
  encoder.Uint(0x0102030405060708);
  encoder.Int(-2);
  encoder.Double(1.0);
  encoder.Bool(true);
  encoder.String("ab");
  EXPECT_EQ(encoder.bytes(), std::string("\x08\x07\x06\x05\x04\x03\x02\x01"
                                         "\xfe\xff\xff\xff\xff\xff\xff\xff"
                                         "\0\0\0\0\0\0\xf0\x3f"
                                         "\x01\0\0\0\0\0\0\0"
                                         "\x02\0\0\0\0\0\0\0"
                                         "ab",
                                         42));
}

RC_GTEST_PROP(CanonicalEncoderTest, TheDecoderGivesBackWhatWasEncoded,
              (std::uint64_t u, std::int64_t i, double d, bool b, const std::string& s)) {
  CanonicalEncoder encoder;
  encoder.String(s);
  encoder.Uint(u);
  encoder.Int(i);
  encoder.Double(d);
  encoder.Bool(b);
  const std::string bytes = encoder.Take();
  CanonicalDecoder decoder(bytes);
  RC_ASSERT(decoder.String() == s);
  RC_ASSERT(decoder.Uint() == u);
  RC_ASSERT(decoder.Int() == i);
  RC_ASSERT(std::bit_cast<std::uint64_t>(decoder.Double()) == std::bit_cast<std::uint64_t>(d));
  RC_ASSERT(decoder.Bool() == b);
  RC_ASSERT(decoder.ok());
  RC_ASSERT(decoder.AtEnd());
}

RC_GTEST_PROP(CanonicalEncoderTest, ACutEncodingIsNoticedWhereverItIsCut, (const std::string& s)) {
  CanonicalEncoder encoder;
  encoder.Uint(7);
  encoder.String(s);
  encoder.Double(0.5);
  const std::string& whole = encoder.bytes();
  const auto cut = *rc::gen::inRange<std::size_t>(0, whole.size());
  CanonicalDecoder decoder(std::string_view(whole).substr(0, cut));
  decoder.Uint();
  decoder.String();
  decoder.Double();
  RC_ASSERT(!decoder.ok());
  RC_ASSERT(decoder.Uint() == 0u);
}

TEST(CanonicalEncoderTest, AnAbsurdLengthIsRefusedWithoutAllocatingIt) {
  CanonicalEncoder encoder;
  encoder.Uint(std::numeric_limits<std::uint64_t>::max());
  CanonicalDecoder decoder(encoder.bytes());
  EXPECT_EQ(decoder.String(), "");
  EXPECT_FALSE(decoder.ok());
}

// Test vectors of the FNV reference page, http://www.isthe.com/chongo/tech/comp/fnv/.
TEST(HashTest, IsFnv1a) {
  const auto hash = [](std::string_view bytes) {
    Fnv1a64 fnv;
    fnv.AddBytes(bytes);
    return fnv.value();
  };
  EXPECT_EQ(hash(""), 0xcbf29ce484222325u);
  EXPECT_EQ(hash("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(hash("foobar"), 0x85944171f73967e8u);
}

TEST(HashTest, NumbersCountByTheirBytes) {
  Fnv1a64 number;
  number.AddUint64(0x726162);
  Fnv1a64 bytes;
  bytes.AddBytes(std::string_view("bar\0\0\0\0\0", 8));
  EXPECT_EQ(number.value(), bytes.value());
  Fnv1a64 zero;
  zero.AddDouble(0.0);
  Fnv1a64 minus_zero;
  minus_zero.AddDouble(-0.0);
  EXPECT_NE(zero.value(), minus_zero.value());
}

TEST(NumberTextTest, IsTheShortestThatReadsBack) {
  EXPECT_EQ(NumberText(0.8), "0.8");
  EXPECT_EQ(NumberText(100.0), "100");
  EXPECT_EQ(NumberText(-2.5), "-2.5");
  EXPECT_EQ(NumberText(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(NumberText(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(NumberText(std::nan("")), "nan");
  EXPECT_EQ(NumberText(-std::numeric_limits<double>::min()), "-2.2250738585072014e-308");
  EXPECT_EQ(PointText(2.5, -3), "(2.5, -3)");
}

TEST(ResultTest, HoldsAValueOrAnError) {
  const Result<int> value = 3;
  ASSERT_TRUE(value.ok());
  EXPECT_EQ(*value, 3);
  const Result<int> error = InvalidInput("length -1 m; want more than 0");
  ASSERT_FALSE(error.ok());
  EXPECT_EQ(error.error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(error.error().message, "length -1 m; want more than 0");
}

TEST(ResultDeathTest, TakingTheValueOfAnErrorEndsTheProcessWithItsMessage) {
  const Result<int> error = InvalidInput("length -1 m");
  EXPECT_DEATH((void)error.value(), "length -1 m");
}

TEST(CheckDeathTest, NamesTheConditionAndTheValues) {
  const int robots = -1;
  EXPECT_DEATH(GAUNTLET_CHECK(robots >= 0, "robots " + std::to_string(robots)), "robots >= 0: robots -1");
}

TEST(MeanAndRangeTest, OfSomeValuesAndOfNone) {
  MeanAndRange some;
  EXPECT_TRUE(std::isnan(some.mean()) && std::isnan(some.lowest()) && std::isnan(some.highest()));
  for (const double value : {3.0, 1.0}) some.Add(value);
  MeanAndRange more;
  more.Add(8.0);
  some.Add(more);
  some.Add(MeanAndRange());
  EXPECT_EQ(some.count(), 3U);
  EXPECT_EQ(some.lowest(), 1.0);
  EXPECT_EQ(some.mean(), 4.0);
  EXPECT_EQ(some.highest(), 8.0);
}

}  // namespace
}  // namespace gauntlet
