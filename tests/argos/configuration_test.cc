// Covers: argos/argos_configuration.cc
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/math/quaternion.h>

#include <gtest/gtest.h>

#include <string>

namespace argos {
namespace {

class Configuration : public testing::Test {
 protected:
  Configuration() {
    node_.SetAttributeText("number", "3.7");
    node_.SetAttributeText("flag", "true");
    node_.SetAttributeText("word", "two words");
    node_.SetAttributeText("angle", "90");
    node_.SetAttributeText("range", "-1:2.5");
    node_.SetAttributeText("vector", "1,2,3");
    node_.SetAttributeText("color", "orange");
    for (const char* tag : {"wheels", "camera", "wheels"}) node_.AddChild(TConfigurationNode(tag));
  }

  template <typename T>
  T Get(const std::string& name) {
    T value{};
    GetNodeAttribute(node_, name, value);
    return value;
  }

  TConfigurationNode node_ = TConfigurationNode("params");
};

TEST_F(Configuration, ReadsAttributesAsTheirTypes) {
  EXPECT_EQ(Get<Real>("number"), 3.7);
  EXPECT_EQ(Get<UInt32>("number"), 3u);  // what cannot be read further is left
  EXPECT_EQ(Get<UInt8>("number"), 3);
  EXPECT_TRUE(Get<bool>("flag"));
  EXPECT_EQ(Get<std::string>("word"), "two words");
  EXPECT_EQ(Get<CDegrees>("angle"), CDegrees(90.0));
  EXPECT_EQ(Get<CRange<Real>>("range").GetMax(), 2.5);
  EXPECT_EQ(Get<CVector3>("vector"), CVector3(1.0, 2.0, 3.0));
  EXPECT_EQ(Get<CColor>("color"), CColor::ORANGE);
}

TEST_F(Configuration, RefusesWhatIsAbsentOrBad) {
  EXPECT_THROW(Get<Real>("nothing"), CARGoSException);
  EXPECT_THROW(Get<Real>("word"), CARGoSException);
  EXPECT_THROW(Get<bool>("number"), CARGoSException);
  EXPECT_THROW(GetNode(node_, "gripper"), CARGoSException);
}

TEST_F(Configuration, TakesTheDefaultOfWhatIsAbsentOnly) {
  Real value = 0.0;
  GetNodeAttributeOrDefault(node_, "nothing", value, 5.0);
  EXPECT_EQ(value, 5.0);
  GetNodeAttributeOrDefault(node_, "number", value, 5.0);
  EXPECT_EQ(value, 3.7);
  EXPECT_THROW(GetNodeAttributeOrDefault(node_, "word", value, 5.0), CARGoSException);
}

TEST_F(Configuration, WalksChildren) {
  int all = 0;
  TConfigurationNodeIterator any;
  for (any = any.begin(&node_); any != any.end(); ++any) ++all;
  EXPECT_EQ(all, 3);
  int wheels = 0;
  TConfigurationNodeIterator some("wheels");
  for (some = some.begin(&node_); some != some.end(); ++some) wheels += some->Value() == "wheels" ? 1 : 0;
  EXPECT_EQ(wheels, 2);
}

TEST_F(Configuration, CopiesStandForTheSameElement) {
  TConfigurationNode copy = GetNode(node_, "camera");
  SetNodeAttribute(copy, "aperture", 80);
  EXPECT_TRUE(NodeAttributeExists(GetNode(node_, "camera"), "aperture"));
}

TEST(Colors, HaveNamesAndParts) {
  EXPECT_EQ(ToString(CColor(255, 140, 0)), "orange");
  EXPECT_EQ(ToString(CColor(1, 2, 3, 4)), "1,2,3,4");
  EXPECT_NE(CColor(255, 0, 0, 10), CColor::RED);
  EXPECT_EQ(CColor(100, 0, 0).ToGrayScale(), 29);
  CColor color;
  EXPECT_THROW(color.Set("reddish"), CARGoSException);
  EXPECT_THROW(color.Set("1,2,300"), CARGoSException);
}

}  // namespace
}  // namespace argos
