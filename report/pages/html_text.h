// Pieces of HTML that pages share.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "analysis/tables/html.h"
#include "analysis/tables/table.h"
#include "report/figures/campaign_figures.h"

namespace gauntlet {

// A JSON value on one line that cannot end the script element it stands in. Bytes that are not UTF-8 become
// U+FFFD.
std::string JsonInHtml(const nlohmann::ordered_json& value);

// The command that writes a figure for a paper, with these options, to be unfolded.
std::string ForAPaperHtml(const std::string& figure, const std::string& directory,
                          const std::string& options = "");
// The figure, what it shows, and the command that writes it for a paper, with these options.
std::string FigureHtml(const NamedFigure& figure, const std::string& directory,
                       const std::string& options = "");

}  // namespace gauntlet
