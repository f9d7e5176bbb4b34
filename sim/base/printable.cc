#include "sim/base/printable.h"

namespace gauntlet {
namespace {

std::string HexEscape(unsigned byte) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  return std::string("\\x") + kDigits[byte / 16] + kDigits[byte % 16];
}

}  // namespace

std::string Printable(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
    if (byte == '\n') {
      out += "\\n";
    } else if (byte == '\t') {
      out += "\\t";
    } else if (byte < 0x20U || byte == 0x7FU) {
      out += HexEscape(byte);
    } else if (byte == 0xC2U && next >= 0x80U && next < 0xA0U) {  // a control character of two bytes
      out += HexEscape(next);
      ++i;
    } else {
      out += text[i];
    }
  }
  return out;
}

}  // namespace gauntlet
