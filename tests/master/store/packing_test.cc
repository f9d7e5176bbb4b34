// What is packed comes back, whatever it was packed with, and what is no packed bytes is refused.
#include "master/store/packing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace gauntlet {
namespace {

std::string Example() {
  std::string text;
  for (int i = 0; i < 60; ++i) text += "parameter " + std::to_string(i * i) + ";";
  return text;
}

RC_GTEST_PROP(PackingTest, EverythingComesBack, (const std::string& bytes)) {
  for (const bool learned : {false, true}) {
    Packing packing;
    if (learned) packing.Learn(Example());
    const std::string packed = packing.Pack(bytes);
    RC_ASSERT(packed.size() <= bytes.size() + 1);
    const Result<std::string> back = packing.Unpack(packed);
    RC_ASSERT(back.ok());
    RC_ASSERT(*back == bytes);
  }
}

TEST(PackingTest, WhatResemblesTheExampleBecomesSmall) {
  Packing packing;
  const std::string alone = packing.Pack(Example());
  packing.Learn(Example());
  std::string other = Example();
  other[100] = 'X';
  const std::string packed = packing.Pack(other);
  EXPECT_LT(packed.size(), 40U);
  EXPECT_LT(packed.size(), alone.size() / 2);
  EXPECT_EQ(packing.Unpack(packed).value(), other);
  EXPECT_EQ(packing.Unpack(alone).value(), Example()) << "packed before anything was learned";
}

TEST(PackingTest, WhatDiffersInAShortStretchIsNotCompressedAgain) {
  for (const bool learned : {false, true}) {
    Packing packing;
    if (learned) packing.Learn("another " + Example());
    const std::string whole = packing.Pack(Example());
    (void)packing.Pack(Example() + "of another length");  // of another worker, between them
    const std::size_t end = Example().size();
    for (const auto& [from, count] : std::vector<std::pair<std::size_t, std::size_t>>{
             {0, 1}, {0, 0}, {300, 8}, {300, 16}, {end - 8, 8}, {end - 1, 1}}) {
      std::string other = Example();
      for (std::size_t i = from; i < from + count; ++i) other[i] = 'X';
      const std::string packed = packing.Pack(other);
      EXPECT_THAT(packed, testing::AllOf(testing::StartsWith("c"), testing::EndsWith(whole)));
      EXPECT_EQ(packing.Unpack(packed).value(), other) << from << ' ' << count;
    }
    std::string far = Example();
    far[0] = far[17] = 'X';  // a stretch of seventeen bytes
    EXPECT_THAT(packing.Pack(far), testing::Not(testing::StartsWith("c")));
  }
}

TEST(PackingTest, WithoutTheExampleNothingIsGuessed) {
  Packing with;
  with.Learn(Example());
  const std::string packed = with.Pack(Example());
  Packing without;
  const Result<std::string> bytes = without.Unpack(packed);
  ASSERT_FALSE(bytes.ok());
  EXPECT_EQ(bytes.error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(bytes.error().message, "the example that the bytes were packed with is missing");
}

TEST(PackingTest, OtherBytesAreRefused) {
  Packing packing;
  packing.Learn(Example());
  const std::string packed = packing.Pack(Example() + "more");
  const auto changed = [](std::uint32_t where, char count, const std::string& rest) {
    return "c" + std::string(reinterpret_cast<const char*>(&where), 4) + count + rest;
  };
  // The last of the first row says that it holds 2^40 bytes.
  for (const std::string& bytes :
       {std::string(), std::string("x123"), std::string("z"), std::string("zabc"), packed.substr(0, 8),
        std::string("e\x28\xb5\x2f\xfd\xe0\0\0\0\0\0\1\0\0", 14),  //
        std::string("c"), changed(0, 1, ""), changed(0, 1, "X"),
        changed(0, 17, std::string(17, 'X') + "pabc"), changed(3, 1, "Xpabc"),
        changed(UINT32_MAX, 1, "Xpabc"), changed(0, 4, "ABCDpabc"),
        changed(0, 1, "X" + changed(0, 1, "Ypabc")), changed(0, 1, "Xx123")}) {
    const Result<std::string> back = packing.Unpack(bytes);
    ASSERT_FALSE(back.ok());
    EXPECT_EQ(back.error().kind, ErrorKind::kCorrupt);
  }
}

RC_GTEST_PROP(PackingTest, DamagedBytesNeverCrash, ()) {
  Packing packing;
  packing.Learn(Example());
  std::string packed = packing.Pack(Example() + Example());
  if (*rc::gen::arbitrary<bool>()) packed = packing.Pack(Example() + Example());  // the same again: changed
  const auto place = *rc::gen::inRange<std::size_t>(0, packed.size());
  packed[place] = *rc::gen::arbitrary<char>();
  (void)packing.Unpack(packed);
}

}  // namespace
}  // namespace gauntlet
