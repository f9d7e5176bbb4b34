#include "analysis/tables/html.h"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/figures/svg_canvas.h"

namespace gauntlet {

std::string Html(std::string_view text) {
  return analysis::EscapeXml(text);
}

std::string HtmlLines(std::string_view text) {
  std::string html;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    html += Html(text.substr(0, end)) + "\n";
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return html;
}

std::string ParagraphHtml(std::string_view text, std::string_view style) {
  const std::string attribute = style.empty() ? "" : fmt::format(" class=\"{}\"", style);
  return text.empty() ? "" : fmt::format("<p{}>{}</p>\n", attribute, Html(text));
}

std::string CommandHtml(std::string_view command) {
  return fmt::format("<div class=\"command\"><code>{}</code></div>\n", Html(command));
}

std::string DataUri(std::string_view svg) {
  constexpr std::string_view kEscaped = "%#\"<>&\n";
  std::string uri = "data:image/svg+xml,";
  for (const char one : svg) {
    if (kEscaped.find(one) == std::string_view::npos) {
      uri += one;
    } else {
      uri += fmt::format("%{:02X}", static_cast<int>(one));
    }
  }
  return uri;
}

std::string PictureHtml(std::string_view svg, std::string_view title, std::string_view reading,
                        std::string_view more) {
  return fmt::format(
      "<figure><div class=\"scroll\"><img alt=\"{}\" "
      "src=\"{}\"></div>\n<figcaption>{}{}</figcaption></figure>\n",
      Html(title), DataUri(svg), Html(reading), more);
}

}  // namespace gauntlet
