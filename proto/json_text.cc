#include "proto/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "base/printable.h"
#include "base/utf8.h"

namespace gauntlet {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxDepth = 64;

// Follows the parser through the document, so that errors can name the path of the value at hand.
class Path {
 public:
  // Takes part in parsing. Throws an Error at a key that repeats another and where nesting is too deep.
  bool operator()(Json::parse_event_t event, const Json& parsed) {
    switch (event) {
      case Json::parse_event_t::object_start:
      case Json::parse_event_t::array_start:
        if (levels_.size() == kMaxDepth)
          throw Error(InvalidInput(fmt::format("nested deeper than {} levels", kMaxDepth)));
        levels_.push_back({event == Json::parse_event_t::array_start, 0, "", {}});
        break;
      case Json::parse_event_t::key:
        levels_.back().key = parsed.get<std::string>();
        if (levels_.back().keys.insert(levels_.back().key).second) break;
        throw Error(InvalidInput(Text() + " is given twice"));
      case Json::parse_event_t::object_end:
      case Json::parse_event_t::array_end:
        levels_.pop_back();
        [[fallthrough]];
      case Json::parse_event_t::value:
        if (!levels_.empty()) ++levels_.back().index;
        break;
    }
    return true;
  }

  // "obstacles[3].x"
  std::string Text() const {
    std::string text;
    for (const Level& level : levels_) {
      text += level.in_array ? fmt::format("[{}]", level.index) : (text.empty() ? "" : ".") + level.key;
    }
    return text;
  }

 private:
  struct Level {
    bool in_array = false;
    std::size_t index = 0;
    std::string key;
    std::set<std::string> keys;
  };
  std::vector<Level> levels_;
};

// The library's words without what it has read: "unexpected number literal; expected ':'".
std::string WordsOf(const Json::parse_error& error) {
  std::string words = error.what();
  if (const std::size_t reason = words.find(" - "); reason != std::string::npos) words.erase(0, reason + 3);
  return words.substr(0, words.find("; last read: "));
}

}  // namespace

std::string JsonText(const nlohmann::ordered_json& value) {
  return value.dump(2, ' ', /*ensure_ascii=*/false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<Json> ParseJson(std::string_view text, const std::string& file_name) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const auto wrong = [&](const std::string& what) { return InvalidInput(Printable(file_name + what)); };
  Path path;
  try {
    return Json::parse(text, [&](int /*depth*/, Json::parse_event_t event, const Json& parsed) {
      return path(event, parsed);
    });
  } catch (const Error& error) {
    return wrong(": " + error.message);
  } catch (const Json::parse_error& error) {
    return wrong(
        fmt::format(":{}: {}", PlaceIn(text, std::max<std::size_t>(error.byte, 1) - 1), WordsOf(error)));
  } catch (const Json::exception&) {
    return wrong(fmt::format(": {}{}a number beyond the range of a double", path.Text(),
                             path.Text().empty() ? "" : ": "));
  }
}

std::string TextAt(const Json& json, const char* key) {
  return json.is_object() && json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
}

}  // namespace gauntlet
