// Covers: argos/plugin_main.cc
#include "argos/plugin_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "argos/controller_adapter.h"

namespace {

// Keeps what Init reads.
class CReader : public argos::CCI_Controller {
 public:
  inline static double speed = 0.0;
  inline static std::vector<int> ports;
  inline static std::string name;
  inline static std::string id;
  inline static std::string wish;
  inline static double limit = 0.0;

  void Init(argos::TConfigurationNode& parameters) override {
    argos::GetNodeAttribute(argos::GetNode(parameters, "wheels"), "speed", speed);
    argos::GetNodeAttribute(parameters, "name", name);
    id = GetId();
    argos::GetNodeText(argos::GetNode(parameters, "wheels"), wish);
    argos::GetNodeTextOrDefault(argos::GetNode(parameters, "limit"), limit, 3.0);
    ports.clear();
    argos::TConfigurationNodeIterator port("port");
    for (port = port.begin(&parameters); port != port.end(); ++port) {
      argos::GetNodeAttribute(*port, "number", ports.emplace_back());
    }
  }
};

}  // namespace

REGISTER_CONTROLLER(CReader, "reader")

namespace gauntlet::argos_form {
namespace {

using controllers::ControllerInfo;
using testing::ElementsAre;

constexpr ConfigurationLine kLines[] = {
    {0, "somebody_else"}, {1, "id", "x"},        {0, "reader"},
    {1, "id", "first"},   {1, " robots", "F0-"}, {1, " rab_data_size", "24"},
    {1, "actuators"},     {2, "leds"},           {3, "medium", "leds"},
    {1, "sensors"},       {2, "positioning"},    {1, "params"},
    {2, "name", "seven"}, {2, "wheels"},         {3, "speed", "2.50"},
    {3, "", "a wish"},    {2, "limit"},          {3, "", "2.5"},
    {2, "port"},          {3, "number", "1"},    {2, "port"},
    {3, "number", "2"},   {0, "reader"},         {1, "id", "second"},
    {1, "params"},        {2, "name", "8"},      {2, "wheels"},
    {3, "speed", "9"},    {3, "", "another"},    {2, "limit"},
};

const ControllerInfo& RowNamed(const std::vector<ControllerInfo>& rows, const std::string& name) {
  for (const ControllerInfo& row : rows) {
    if (row.name == name) return row;
  }
  ADD_FAILURE() << "no row is called " << name;
  return rows.front();
}

sim::Parameters DefaultsOf(const ControllerInfo& row) {
  sim::Parameters defaults;
  for (const auto& parameter : row.parameters)
    defaults[std::string(parameter.name)] = parameter.default_value;
  return defaults;
}

TEST(ControllerRows, MakeAParameterOfEveryNumber) {
  const auto rows = ControllerRows(kLines);
  const ControllerInfo& row = RowNamed(rows, "reader");
  EXPECT_EQ(row.scenario, "any");
  EXPECT_EQ(DefaultsOf(row),
            (sim::Parameters{
                {"link_range", 1.35}, {"port-2.number", 2}, {"port.number", 1}, {"wheels.speed", 2.5}}));
}

TEST(ControllerRows, HandTheValuesToInit) {
  const auto rows = ControllerRows(kLines);
  const ControllerInfo& row = RowNamed(rows, "reader");
  sim::Parameters values = DefaultsOf(row);
  values["wheels.speed"] = 4.25;
  values["port-2.number"] = 6;
  const auto robot = row.make(values).create({});
  EXPECT_EQ(CReader::speed, 4.25);
  EXPECT_EQ(CReader::name, "seven");
  EXPECT_EQ(CReader::wish, "a wish");
  EXPECT_EQ(CReader::limit, 2.5);
  EXPECT_EQ(CReader::id, "F0-0");
  EXPECT_THAT(CReader::ports, ElementsAre(1, 6));
  EXPECT_EQ(robot->Devices(), sim::Device::kLeds | sim::Device::kPositioning);
}

TEST(ControllerRows, CallSectionsAfterTheFirstByTheirIds) {
  const auto rows = ControllerRows(kLines);
  const ControllerInfo& row = RowNamed(rows, "second");
  row.make(DefaultsOf(row)).create({});
  EXPECT_EQ(CReader::speed, 9.0);
  EXPECT_EQ(CReader::name, "8");
  EXPECT_EQ(CReader::limit, 3.0);
  EXPECT_EQ(CReader::id, "fb0");
}

TEST(ControllerRows, NameWhatInitMisses) {
  const auto rows = ControllerRows({});
  const ControllerInfo& row = RowNamed(rows, "reader");
  try {
    row.make(DefaultsOf(row)).create({});
    FAIL() << "there are no parameters";
  } catch (const argos::CARGoSException& error) {
    EXPECT_STREQ(error.what(), "[FATAL] <params> has no child <wheels>");
  }
}

}  // namespace
}  // namespace gauntlet::argos_form
