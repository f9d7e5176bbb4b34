#include "report/pages/html_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/figures/svg_canvas.h"
#include "base/shell_quoted.h"

namespace gauntlet {
namespace {

std::string Replaced(std::string_view text, std::string_view characters,
                     const std::function<std::string(char)>& by) {
  std::string out;
  out.reserve(text.size() + text.size() / 4);
  for (const char one : text) {
    if (characters.find(one) == std::string_view::npos) {
      out += one;
    } else {
      out += by(one);
    }
  }
  return out;
}

// Names at the left, numbers at the right.
std::string CellHtml(const char* element, bool at_right, const std::string& html) {
  const std::string_view scope = element[1] == 'h' ? " scope=\"col\"" : "";
  return fmt::format("<{}{}{}>{}</{}>", element, scope, at_right ? " class=\"number\"" : "", html, element);
}

}  // namespace

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

std::string DataUri(std::string_view svg) {
  return "data:image/svg+xml," +
         Replaced(svg, "%#\"<>&\n", [](char one) { return fmt::format("%{:02X}", static_cast<int>(one)); });
}

std::string JsonInHtml(const nlohmann::ordered_json& value) {
  const std::string text = value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return Replaced(text, "<>&", [](char one) { return fmt::format("\\u{:04x}", static_cast<int>(one)); });
}

std::string TableHtml(const std::vector<std::string>& headers,
                      const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  std::vector<bool> at_right;
  for (const std::string& header : headers) {
    at_right.push_back(header.starts_with('>'));
    html += CellHtml("th", at_right.back(), Html(header.substr(at_right.back() ? 1 : 0)));
  }
  html += "</tr></thead><tbody>\n";
  for (const std::vector<std::string>& row : rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) html += CellHtml("td", at_right.at(i), row[i]);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string FactsHtml(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string html = "<div class=\"scroll\"><table class=\"facts\"><tbody>\n";
  for (const auto& [name, value] : facts) {
    if (!value.empty()) html += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", name, value);
  }
  return html + "</tbody></table></div>\n";
}

std::string CommandHtml(const std::string& command) {
  return fmt::format("<div class=\"command\"><code>{}</code></div>\n", Html(command));
}

std::string FigureHtml(const NamedFigure& figure, const std::string& directory, const std::string& options) {
  return fmt::format(
      "<figure><div class=\"scroll\"><img alt=\"{}\" src=\"{}\"></div>\n"
      "<figcaption>{}<details><summary>For a paper: as SVG, its data as CSV</summary>{}</details>"
      "</figcaption></figure>\n",
      Html(figure.title), DataUri(figure.svg()), Html(figure.reading),
      CommandHtml(fmt::format("gauntlet figure {0} {1}{2} -o {1}.svg --csv {1}.csv", PastedPath(directory),
                              figure.name, options)));
}

}  // namespace gauntlet
