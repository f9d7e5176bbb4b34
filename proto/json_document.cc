#include "proto/json_document.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/printable.h"

namespace gauntlet::proto {
namespace {

constexpr int kMaxDepth = 64;

// Length of the UTF-8 sequence at the front of `text`; 0 when it is none.
std::size_t SequenceLength(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // Overlong forms, surrogates and what lies beyond U+10FFFF.
  if (first == 0xE0 && byte(1) < 0xA0) return 0;
  if (first == 0xED && byte(1) > 0x9F) return 0;
  if (first == 0xF0 && byte(1) < 0x90) return 0;
  if (first == 0xF4 && byte(1) > 0x8F) return 0;
  return length;
}

void AppendUtf8(std::string& text, std::uint32_t code) {
  const auto put = [&text](std::uint32_t byte) { text.push_back(static_cast<char>(byte)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | (code >> 6));
    put(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    put(0xE0 | (code >> 12));
    put(0x80 | ((code >> 6) & 0x3F));
    put(0x80 | (code & 0x3F));
  } else {
    put(0xF0 | (code >> 18));
    put(0x80 | ((code >> 12) & 0x3F));
    put(0x80 | ((code >> 6) & 0x3F));
    put(0x80 | (code & 0x3F));
  }
}

// Recursive descent. After the first error every function returns at once; error_ says what was wrong.
class Parser {
 public:
  Parser(std::string_view text, const std::string& file_name) : text_(text), file_name_(file_name) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  }

  Result<JsonValue> Parse() {
    SkipSpace();
    JsonValue value = ParseValue(0);
    SkipSpace();
    if (!error_ && !AtEnd()) Fail("only white space may follow the value, found " + Found());
    if (error_) return *error_;
    return value;
  }

 private:
  bool AtEnd() const { return position_ == text_.size(); }
  char Peek() const { return AtEnd() ? '\0' : text_[position_]; }
  bool TakeIf(char c) {
    if (AtEnd() || text_[position_] != c) return false;
    Take();
    return true;
  }
  void Take() {
    const char c = text_[position_++];
    if (c == '\n') {
      ++place_.line;
      place_.column = 1;
    } else if ((static_cast<std::uint8_t>(c) & 0xC0) != 0x80) {
      ++place_.column;
    }
  }
  void SkipSpace() {
    while (!AtEnd() && (Peek() == ' ' || Peek() == '\t' || Peek() == '\n' || Peek() == '\r')) Take();
  }
  std::string Found() const {
    if (AtEnd()) return "the end of the file";
    const auto c = static_cast<std::uint8_t>(Peek());
    return c < 0x20 || c >= 0x7F ? fmt::format("byte {:#04x}", c) : fmt::format("'{}'", Peek());
  }
  void Fail(const std::string& what) { FailAt(place_, what); }
  void FailAt(TextPlace place, const std::string& what) {
    if (!error_) error_ = ErrorAt(file_name_, place, what);
  }

  JsonValue ParseValue(int depth) {
    JsonValue value;
    value.place = place_;
    if (depth > kMaxDepth) {
      Fail(fmt::format("nested deeper than {} levels", kMaxDepth));
      return value;
    }
    switch (Peek()) {
      case '{':
        value.value = ParseObject(depth);
        break;
      case '[':
        value.value = ParseArray(depth);
        break;
      case '"':
        value.value = ParseString();
        break;
      case 't':
        if (ParseWord("true")) value.value = true;
        break;
      case 'f':
        if (ParseWord("false")) value.value = false;
        break;
      case 'n':
        ParseWord("null");
        break;
      default:
        value.value = ParseNumber();
    }
    return value;
  }

  bool ParseWord(std::string_view word) {
    if (!text_.substr(position_).starts_with(word)) {
      Fail("expected a value, found " + Found());
      return false;
    }
    for (std::size_t i = 0; i < word.size(); ++i) Take();
    return true;
  }

  JsonValue::Number ParseNumber() {
    const TextPlace place = place_;
    const std::size_t start = position_;
    const auto digits = [this] {
      const std::size_t first = position_;
      while (Peek() >= '0' && Peek() <= '9') Take();
      return position_ > first;
    };
    TakeIf('-');
    const bool zero = Peek() == '0';
    const std::size_t integer = position_;
    bool valid = digits() && !(zero && position_ - integer > 1);
    if (valid && TakeIf('.')) valid = digits();
    if (valid && (Peek() == 'e' || Peek() == 'E')) {
      Take();
      if (!TakeIf('+')) TakeIf('-');
      valid = digits();
    }
    JsonValue::Number number{0.0, std::string(text_.substr(start, position_ - start))};
    if (!valid) {
      if (number.text.empty()) {
        Fail("expected a value, found " + Found());
      } else {
        FailAt(place, fmt::format("'{}' is not a number as JSON writes it", number.text));
      }
      return number;
    }
    const char* end = number.text.data() + number.text.size();
    const auto [stop, status] = std::from_chars(number.text.data(), end, number.value);
    const bool all_zero = number.text.find_first_of("123456789") == std::string::npos;
    if (status == std::errc::result_out_of_range && !all_zero) {
      FailAt(place, fmt::format("{} is beyond the range of a double", number.text));
    }
    return number;
  }

  std::string ParseString() {
    const TextPlace start = place_;
    std::string value;
    Take();
    while (!error_) {
      if (AtEnd()) {
        FailAt(start, "this text has no closing quote");
        break;
      }
      const char c = Peek();
      if (c == '"') {
        Take();
        break;
      }
      if (c == '\\') {
        Take();
        ParseEscape(value);
      } else if (static_cast<std::uint8_t>(c) < 0x20) {
        Fail("a text may not hold " + Found() + "; write it as \\n, \\t or \\u00xx");
      } else {
        const std::size_t length = SequenceLength(text_.substr(position_));
        if (length == 0) Fail("not valid UTF-8: " + Found());
        value.append(text_.substr(position_, length));
        for (std::size_t i = 0; i < length; ++i) Take();
      }
    }
    return value;
  }

  std::optional<std::uint32_t> ParseHex4() {
    std::uint32_t code = 0;
    const std::string_view hex = text_.substr(position_, 4);
    const auto [stop, status] = std::from_chars(hex.data(), hex.data() + hex.size(), code, 16);
    if (hex.size() < 4 || status != std::errc() || stop != hex.data() + 4) {
      Fail("\\u needs four hexadecimal digits");
      return std::nullopt;
    }
    for (int i = 0; i < 4; ++i) Take();
    return code;
  }

  void ParseEscape(std::string& value) {
    const std::string_view names = "\"\\/bfnrt";
    const std::string_view meanings = "\"\\/\b\f\n\r\t";
    const std::size_t known = AtEnd() ? std::string_view::npos : names.find(Peek());
    if (known != std::string_view::npos) {
      value.push_back(meanings[known]);
      Take();
      return;
    }
    if (!TakeIf('u')) {
      Fail("unknown escape: \\ before " + Found());
      return;
    }
    std::optional<std::uint32_t> code = ParseHex4();
    if (!code) return;
    if (*code >= 0xD800 && *code < 0xDC00 && TakeIf('\\') && TakeIf('u')) {
      const std::optional<std::uint32_t> low = ParseHex4();
      if (!low) return;
      const bool pair = *low >= 0xDC00 && *low < 0xE000;
      code = pair ? 0x10000 + ((*code - 0xD800) << 10) + (*low - 0xDC00) : 0xD800;
    }
    if (*code >= 0xD800 && *code < 0xE000) {
      Fail("half of a surrogate pair");
      return;
    }
    AppendUtf8(value, *code);
  }

  JsonValue::Array ParseArray(int depth) {
    JsonValue::Array array;
    Take();
    SkipSpace();
    if (TakeIf(']')) return array;
    while (!error_) {
      array.push_back(ParseValue(depth + 1));
      if (error_) break;
      SkipSpace();
      if (TakeIf(']')) break;
      if (!TakeIf(',')) Fail("expected ',' or ']', found " + Found());
      SkipSpace();
    }
    return array;
  }

  JsonValue::Object ParseObject(int depth) {
    JsonValue::Object object;
    Take();
    SkipSpace();
    if (TakeIf('}')) return object;
    while (!error_) {
      JsonMember member;
      member.place = place_;
      if (Peek() != '"') {
        Fail("expected a key in double quotes, found " + Found());
        break;
      }
      member.key = ParseString();
      for (const JsonMember& earlier : object) {
        if (earlier.key == member.key)
          FailAt(member.place, fmt::format("'{}' stands here twice", member.key));
      }
      SkipSpace();
      if (!error_ && !TakeIf(':')) Fail("expected ':', found " + Found());
      if (error_) break;
      SkipSpace();
      member.value = ParseValue(depth + 1);
      object.push_back(std::move(member));
      if (error_) break;
      SkipSpace();
      if (TakeIf('}')) break;
      if (!TakeIf(',')) Fail("expected ',' or '}', found " + Found());
      SkipSpace();
    }
    return object;
  }

  std::string_view text_;
  const std::string& file_name_;
  std::size_t position_ = 0;
  TextPlace place_;
  std::optional<Error> error_;
};

}  // namespace

std::string_view JsonValue::Kind() const {
  constexpr std::string_view kKinds[] = {"null",   "a truth value", "a number",
                                         "a text", "a list",        "an object"};
  return kKinds[value.index()];
}

Error ErrorAt(const std::string& file_name, TextPlace place, const std::string& what) {
  return InvalidInput(Printable(fmt::format("{}:{}:{}: {}", file_name, place.line, place.column, what)));
}

Result<JsonValue> ParseJson(std::string_view text, const std::string& file_name) {
  return Parser(text, file_name).Parse();
}

}  // namespace gauntlet::proto
