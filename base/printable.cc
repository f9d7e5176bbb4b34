#include "base/printable.h"

#include <algorithm>

#include "base/utf8.h"

namespace gauntlet {
namespace {

std::string HexEscape(unsigned byte) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  return std::string("\\x") + kDigits[byte / 16] + kDigits[byte % 16];
}

}  // namespace

std::string Printable(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = Utf8Length(text, i);
    if (byte == '\n') {
      out += "\\n";
    } else if (byte == '\t') {
      out += "\\t";
    } else if (length == 0 || byte < 0x20U || byte == 0x7FU) {
      out += HexEscape(byte);
    } else if (length == 2 && byte == 0xC2U && static_cast<unsigned char>(text[i + 1]) < 0xA0U) {
      out += HexEscape(static_cast<unsigned char>(text[i + 1]));
    } else {
      out += text.substr(i, length);
    }
    i += std::max<std::size_t>(length, 1);
  }
  return out;
}

Error Printable(Error error) {
  error.message = Printable(error.message);
  return error;
}

}  // namespace gauntlet
