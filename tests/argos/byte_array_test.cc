#include <argos3/core/utility/datatypes/byte_array.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace argos {
namespace {

std::vector<int> BytesOf(const CByteArray& array) {
  std::vector<int> bytes;
  for (std::size_t i = 0; i < array.Size(); ++i) bytes.push_back(array[i]);
  return bytes;
}

TEST(ByteArray, PutsIntegersInNetworkOrder) {
  CByteArray array;
  array << UInt8{1} << UInt16{0x0203} << UInt32{0x04050607} << SInt8{-1};
  EXPECT_EQ(BytesOf(array), (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 255}));
  UInt8 one = 0;
  UInt16 two = 0;
  UInt32 four = 0;
  SInt8 minus = 0;
  array >> one >> two >> four >> minus;
  EXPECT_EQ(one, 1);
  EXPECT_EQ(two, 0x0203);
  EXPECT_EQ(four, 0x04050607u);
  EXPECT_EQ(minus, -1);
  EXPECT_TRUE(array.Empty());
}

// As 421bd763 writes them: C++ promotes them, as there is no overload.
TEST(ByteArray, PutsCharactersAndFlagsAsInts) {
  CByteArray array;
  array << 'x' << true;
  EXPECT_EQ(BytesOf(array), (std::vector<int>{0, 0, 0, 120, 0, 0, 0, 1}));
}

TEST(ByteArray, PutsRealNumbersAsArgosDoes) {
  CByteArray array;
  array << 1.5;
  EXPECT_EQ(BytesOf(array), (std::vector<int>{0x40, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1}));
  array.Clear();
  for (const double value : {0.1, -0.1, 0.0, 1.5, -1e300, 3e-200}) array << value;
  for (const double value : {0.1, -0.1, 0.0, 1.5, -1e300, 3e-200}) EXPECT_EQ(array.PopFront<double>(), value);
}

TEST(ByteArray, EndsTextsWithAZero) {
  CByteArray array;
  array << std::string("ab") << UInt8{7};
  EXPECT_EQ(BytesOf(array), (std::vector<int>{'a', 'b', 0, 7}));
  std::string text;
  array >> text;
  EXPECT_EQ(text, "ab");
  EXPECT_EQ(array.Size(), 1u);
}

TEST(ByteArray, RefusesWhatItDoesNotHave) {
  CByteArray array(3, 9);
  EXPECT_THROW(array[3], CARGoSException);
  UInt32 four = 0;
  EXPECT_THROW(array >> four, CARGoSException);
  EXPECT_THROW(array(1, 4), CARGoSException);
  EXPECT_EQ(CByteArray().ToCArray(), nullptr);
}

TEST(ByteArray, GivesParts) {
  CByteArray array;
  array << UInt8{1} << UInt8{2} << UInt8{3};
  const std::unique_ptr<CByteArray> middle(array(1, 2));
  EXPECT_EQ(BytesOf(*middle), (std::vector<int>{2}));
  const std::unique_ptr<CByteArray> rest(array(1));
  EXPECT_EQ(BytesOf(*rest), (std::vector<int>{2, 3}));
}

}  // namespace
}  // namespace argos
