#include "proto/json_message.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <vector>

#include "base/nearest_name.h"

namespace gauntlet::proto {
namespace {

namespace pb = google::protobuf;

class Filler {
 public:
  explicit Filler(const std::string& file_name) : file_name_(file_name) {}

  // `path` names the message in errors: "obstacles[3]"; "" is the document itself.
  Status Fill(const JsonValue& json, const std::string& path, pb::Message& message) {
    const auto* object = std::get_if<JsonValue::Object>(&json.value);
    if (object == nullptr) return WrongKind(json, path, "an object { ... }");
    std::set<const pb::FieldDescriptor*> given;
    for (const JsonMember& member : *object) {
      const pb::FieldDescriptor* field = Find(*message.GetDescriptor(), member.key);
      if (field == nullptr) return UnknownKey(member, path, *message.GetDescriptor());
      const std::string name = path.empty() ? member.key : path + "." + member.key;
      if (!given.insert(field).second) {
        return ErrorAt(file_name_, member.place, fmt::format("{} is given under two spellings", name));
      }
      Status filled = FillField(member.value, name, field, message);
      if (!filled) return filled;
    }
    return Ok{};
  }

 private:
  static const pb::FieldDescriptor* Find(const pb::Descriptor& descriptor, const std::string& key) {
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const pb::FieldDescriptor* field = descriptor.field(i);
      if (field->name() == key || field->json_name() == key) return field;
    }
    return nullptr;
  }

  Error UnknownKey(const JsonMember& member, const std::string& path,
                   const pb::Descriptor& descriptor) const {
    std::vector<std::string_view> names;
    std::string list;
    for (int i = 0; i < descriptor.field_count(); ++i) {
      names.emplace_back(descriptor.field(i)->json_name());
      list += (i == 0 ? "" : ", ") + descriptor.field(i)->json_name();
    }
    const std::string nearest = NearestName(member.key, names);
    return ErrorAt(file_name_, member.place,
                   fmt::format("unknown key '{}'{}; {}", member.key, path.empty() ? "" : " in " + path,
                               nearest.empty() ? "known: " + list : "did you mean '" + nearest + "'?"));
  }

  Error WrongKind(const JsonValue& json, const std::string& path, const std::string& wanted) const {
    std::string found(json.Kind());
    if (const auto* number = std::get_if<JsonValue::Number>(&json.value)) found = number->text;
    if (const auto* text = std::get_if<std::string>(&json.value))
      found = fmt::format("the text \"{}\"", *text);
    if (const auto* truth = std::get_if<bool>(&json.value)) found = *truth ? "true" : "false";
    return ErrorAt(file_name_, json.place,
                   fmt::format("{} must be {}, not {}", path.empty() ? "the document" : path, wanted, found));
  }

  Result<double> NumberOf(const JsonValue& json, const std::string& path) const {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (const auto* number = std::get_if<JsonValue::Number>(&json.value)) {
      value = number->value;
    } else if (const auto* text = std::get_if<std::string>(&json.value)) {
      const char* end = text->data() + text->size();
      const auto [stop, status] = std::from_chars(text->data(), end, value);
      if (status != std::errc() || stop != end) value = std::numeric_limits<double>::quiet_NaN();
    }
    if (!std::isfinite(value)) return WrongKind(json, path, "a finite number");
    return value;
  }

  Status FillField(const JsonValue& json, const std::string& path, const pb::FieldDescriptor* field,
                   pb::Message& message) {
    if (std::holds_alternative<JsonValue::Null>(json.value)) return Ok{};
    const pb::Reflection& reflection = *message.GetReflection();
    if (field->is_repeated()) {
      const auto* array = std::get_if<JsonValue::Array>(&json.value);
      if (array == nullptr) return WrongKind(json, path, "a list [ ... ]");
      GAUNTLET_CHECK(field->cpp_type() == pb::FieldDescriptor::CPPTYPE_MESSAGE, "unsupported list " + path);
      for (std::size_t i = 0; i < array->size(); ++i) {
        Status filled =
            Fill((*array)[i], fmt::format("{}[{}]", path, i), *reflection.AddMessage(&message, field));
        if (!filled) return filled;
      }
      return Ok{};
    }
    switch (field->cpp_type()) {
      case pb::FieldDescriptor::CPPTYPE_MESSAGE:
        return Fill(json, path, *reflection.MutableMessage(&message, field));
      case pb::FieldDescriptor::CPPTYPE_STRING: {
        const auto* text = std::get_if<std::string>(&json.value);
        if (text == nullptr) return WrongKind(json, path, "a text in double quotes");
        reflection.SetString(&message, field, *text);
        return Ok{};
      }
      case pb::FieldDescriptor::CPPTYPE_DOUBLE: {
        const Result<double> number = NumberOf(json, path);
        if (!number) return number.error();
        reflection.SetDouble(&message, field, *number);
        return Ok{};
      }
      case pb::FieldDescriptor::CPPTYPE_INT32: {
        const Result<double> number = NumberOf(json, path);
        const bool whole =
            number.ok() && std::floor(*number) == *number && std::fabs(*number) <= 2147483647.0;
        if (!whole) return WrongKind(json, path, "a whole number of at most 2147483647");
        reflection.SetInt32(&message, field, static_cast<std::int32_t>(*number));
        return Ok{};
      }
      default:
        GAUNTLET_CHECK(false, "unsupported type of field " + path);
    }
    return Ok{};
  }

  const std::string& file_name_;
};

}  // namespace

Status FillMessage(const JsonValue& json, const std::string& file_name, pb::Message& message) {
  return Filler(file_name).Fill(json, "", message);
}

}  // namespace gauntlet::proto
