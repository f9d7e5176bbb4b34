#include "base/shell_quoted.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/utf8.h"

namespace gauntlet {

std::string ShellQuoted(std::string_view word) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string PastedPath(std::string_view path) {
  const std::string safe = (path.starts_with('-') ? "./" : "") + std::string(path);
  const auto hidden = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (IsUtf8(safe) && std::none_of(safe.begin(), safe.end(), hidden)) return ShellQuoted(safe);
  std::string quoted = "$'";
  for (const unsigned char c : safe) {
    if (c == '\'' || c == '\\') {
      quoted += {'\\', static_cast<char>(c)};
    } else if (hidden(c) || c >= 0x80) {
      quoted += fmt::format("\\{:03o}", c);
    } else {
      quoted += static_cast<char>(c);
    }
  }
  return quoted + "'";
}

}  // namespace gauntlet
