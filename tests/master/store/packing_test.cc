// What is packed comes back, whatever it was packed with, and what is no packed bytes is refused.
#include "master/store/packing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

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
  // The last says that it holds 2^40 bytes.
  for (const std::string& bytes :
       {std::string(), std::string("x123"), std::string("z"), std::string("zabc"), packed.substr(0, 8),
        std::string("e\x28\xb5\x2f\xfd\xe0\0\0\0\0\0\1\0\0", 14)}) {
    const Result<std::string> back = packing.Unpack(bytes);
    ASSERT_FALSE(back.ok());
    EXPECT_EQ(back.error().kind, ErrorKind::kCorrupt);
  }
}

RC_GTEST_PROP(PackingTest, DamagedBytesNeverCrash, ()) {
  Packing packing;
  packing.Learn(Example());
  std::string packed = packing.Pack(Example() + Example());
  const auto place = *rc::gen::inRange<std::size_t>(0, packed.size());
  packed[place] = *rc::gen::arbitrary<char>();
  (void)packing.Unpack(packed);
}

}  // namespace
}  // namespace gauntlet
