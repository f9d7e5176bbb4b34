#include "report/pages/html_text.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/shell_quoted.h"

namespace gauntlet {

std::string JsonInHtml(const nlohmann::ordered_json& value) {
  const std::string text = value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string html;
  for (const char one : text) {
    if (one == '<' || one == '>' || one == '&') {
      html += fmt::format("\\u{:04x}", static_cast<int>(one));
    } else {
      html += one;
    }
  }
  return html;
}

std::string ForAPaperHtml(const std::string& figure, const std::string& directory,
                          const std::string& options) {
  std::string file = figure;
  std::ranges::replace(file, ':', '-');
  return fmt::format("<details><summary>For a paper: as SVG, its data as CSV</summary>{}</details>\n",
                     CommandHtml(fmt::format("gauntlet figure {0} {1}{2} -o {3}.svg --csv {3}.csv",
                                             PastedPath(directory), figure, options, file)));
}

std::string FigureHtml(const NamedFigure& figure, const std::string& directory, const std::string& options) {
  return PictureHtml(figure.svg(), figure.title, figure.reading,
                     ForAPaperHtml(figure.name, directory, options));
}

}  // namespace gauntlet
