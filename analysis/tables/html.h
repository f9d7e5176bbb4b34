// Pieces of HTML. What others have named (cases, experiments, directories) only ever gets in through Html().
#pragma once

#include <string>
#include <string_view>

namespace gauntlet {

// Any text as text, within an element or between the double quotes of an attribute.
std::string Html(std::string_view text);
// The same for `pre`, with its line breaks.
std::string HtmlLines(std::string_view text);
// A text as a paragraph, of a class when there is one; "" of an empty text.
std::string ParagraphHtml(std::string_view text, std::string_view style = "");
// A command to be copied; a text.
std::string CommandHtml(std::string_view command);

// "data:image/svg+xml,...", fit for a double-quoted attribute.
std::string DataUri(std::string_view svg);
// The picture, what is read out instead of it, and below it how it is read; `more`: HTML that follows.
std::string PictureHtml(std::string_view svg, std::string_view title, std::string_view reading,
                        std::string_view more = "");

}  // namespace gauntlet
