// The schema's promises: numbers that never change, zeros that mean nothing, a format document that is true.
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "proto/protocol.pb.h"
#include "proto/run.pb.h"
#include "tests/support/paths.h"

namespace gauntlet {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::FileDescriptor;

std::string ReadText(const std::string& path) {
  std::ifstream in(std::string(GAUNTLET_SOURCE_DIR) + "/" + path);
  EXPECT_TRUE(in.good()) << path;
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::vector<const FileDescriptor*> Files() {
  return {v1::RunSpec::descriptor()->file(), v1::Envelope::descriptor()->file()};
}

void Describe(const EnumDescriptor& type, std::set<std::string>& lines) {
  for (int i = 0; i < type.value_count(); ++i) {
    lines.insert(type.full_name() + " " + std::to_string(type.value(i)->number()) + " = " +
                 type.value(i)->name());
  }
}

void Describe(const Descriptor& message, std::set<std::string>& lines) {
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& field = *message.field(i);
    std::string type = field.type_name();
    if (field.message_type() != nullptr) type = field.message_type()->full_name();
    if (field.enum_type() != nullptr) type = field.enum_type()->full_name();
    lines.insert(message.full_name() + " " + std::to_string(field.number()) + " = " +
                 (field.is_repeated() ? "repeated " : "") + type + " " + field.name());
  }
  for (int i = 0; i < message.enum_type_count(); ++i) Describe(*message.enum_type(i), lines);
  for (int i = 0; i < message.nested_type_count(); ++i) Describe(*message.nested_type(i), lines);
}

std::set<std::string> Schema() {
  std::set<std::string> lines;
  for (const FileDescriptor* file : Files()) {
    for (int i = 0; i < file->message_type_count(); ++i) Describe(*file->message_type(i), lines);
    for (int i = 0; i < file->enum_type_count(); ++i) Describe(*file->enum_type(i), lines);
  }
  return lines;
}

// On failure: an addition is a new line in field_numbers.txt; a change of an existing line breaks stored
// campaigns.
TEST(SchemaTest, NumbersNamesAndTypesAreTheOnesOnRecord) {
  std::set<std::string> recorded;
  std::ifstream in(GAUNTLET_SOURCE_DIR "/tests/proto/field_numbers.txt");
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line[0] != '#') recorded.insert(line);
  }
  const std::set<std::string> schema = Schema();
  std::vector<std::string> missing;
  std::vector<std::string> added;
  std::set_difference(recorded.begin(), recorded.end(), schema.begin(), schema.end(),
                      std::back_inserter(missing));
  std::set_difference(schema.begin(), schema.end(), recorded.begin(), recorded.end(),
                      std::back_inserter(added));
  EXPECT_THAT(missing, testing::IsEmpty()) << "on record, but changed or gone";
  EXPECT_THAT(added, testing::IsEmpty()) << "new: append to tests/proto/field_numbers.txt";
}

TEST(SchemaTest, EnumZeroIsUnspecified) {
  int enums = 0;
  const auto check = [&](const EnumDescriptor& type) {
    ++enums;
    ASSERT_NE(type.FindValueByNumber(0), nullptr) << type.full_name();
    EXPECT_TRUE(type.FindValueByNumber(0)->name().ends_with("_UNSPECIFIED")) << type.full_name();
  };
  for (const FileDescriptor* file : Files()) {
    for (int i = 0; i < file->enum_type_count(); ++i) check(*file->enum_type(i));
    for (int m = 0; m < file->message_type_count(); ++m) {
      for (int i = 0; i < file->message_type(m)->enum_type_count(); ++i)
        check(*file->message_type(m)->enum_type(i));
    }
  }
  EXPECT_EQ(enums, 3);
}

// Protobuf may write map entries in any order: equal results would not give equal bytes.
TEST(SchemaTest, ThereAreNoMaps) {
  for (const FileDescriptor* file : Files()) {
    for (int m = 0; m < file->message_type_count(); ++m) {
      for (int i = 0; i < file->message_type(m)->field_count(); ++i) {
        EXPECT_FALSE(file->message_type(m)->field(i)->is_map())
            << file->message_type(m)->field(i)->full_name();
      }
    }
  }
}

TEST(FormatDocumentTest, NamesEveryMessageOfTheEnvelope) {
  const std::string text = ReadText("proto/README.md");
  const Descriptor& envelope = *v1::Envelope::descriptor();
  for (int i = 0; i < envelope.field_count(); ++i) {
    EXPECT_THAT(text, testing::HasSubstr("| `" + envelope.field(i)->message_type()->name() + "` |"));
  }
}

TEST(FormatDocumentTest, ItsCaseFileIsATestCase) {
  const std::string text = ReadText("proto/README.md");
  const std::size_t section = text.find("## Case files");
  const std::size_t begin = text.find("```json\n", section) + 8;
  const std::size_t end = text.find("```", begin);
  ASSERT_LT(end, text.size());
  v1::TestCase test_case;
  const auto status =
      google::protobuf::util::JsonStringToMessage(text.substr(begin, end - begin), &test_case);
  ASSERT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(test_case.obstacles_size(), 3);
  EXPECT_EQ(test_case.obstacles(2).orientation_deg(), 45.0);
  EXPECT_EQ(test_case.spawn_area().max_y(), 0.5);
  EXPECT_EQ(test_case.robots(), 10);
}

}  // namespace
}  // namespace gauntlet
