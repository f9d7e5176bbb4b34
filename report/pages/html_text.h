// Pieces of HTML. What others have named (cases, experiments, directories) only ever gets in through Html().
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "report/figures/campaign_figures.h"

namespace gauntlet {

// Any text as text, within an element or between the double quotes of an attribute.
std::string Html(std::string_view text);
// The same for `pre`, with its line breaks.
std::string HtmlLines(std::string_view text);

// "data:image/svg+xml,...", fit for a double-quoted attribute.
std::string DataUri(std::string_view svg);

// A JSON value on one line that cannot end the script element it stands in. Bytes that are not UTF-8 become
// U+FFFD.
std::string JsonInHtml(const nlohmann::ordered_json& value);

// Headers are texts, '>' in front moves a column to the right; cells are HTML.
std::string TableHtml(const std::vector<std::string>& headers,
                      const std::vector<std::vector<std::string>>& rows);
// A table of names and values; both are HTML. Rows without a value are left out.
std::string FactsHtml(const std::vector<std::pair<std::string, std::string>>& facts);
// A command to be copied; a text.
std::string CommandHtml(const std::string& command);
// The figure, what it shows, and the command that writes it for a paper, with these options.
std::string FigureHtml(const NamedFigure& figure, const std::string& directory,
                       const std::string& options = "");

}  // namespace gauntlet
