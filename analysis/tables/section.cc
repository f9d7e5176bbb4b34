#include "analysis/tables/section.h"

#include <fmt/format.h>

#include "analysis/tables/html.h"
#include "base/printable.h"

namespace gauntlet {
namespace {

constexpr std::size_t kTextWidth = 110;

std::string SentencesText(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& one : sentences)
    text += fmt::format("  {}\n", Wrapped(Printable(one), kTextWidth, 2));
  return text;
}

std::string SentencesHtml(const std::vector<std::string>& sentences) {
  std::string html;
  for (const std::string& one : sentences) html += ParagraphHtml(one);
  return html;
}

}  // namespace

std::string ToText(const Section& section) {
  std::string text = section.title.empty() ? "" : fmt::format("\n{}\n", Printable(section.title));
  text += SentencesText(section.lead);
  if (!section.table.empty()) text += section.table.ToText();
  text += SentencesText(section.sentences);
  Table commands({"", ""});
  for (const NextCommand& one : section.commands)
    commands.AddRow({one.command, one.purpose.empty() ? "" : "# " + one.purpose});
  return text + commands.ToText();
}

std::string ToHtml(const Section& section) {
  std::string html = section.title.empty() ? "" : fmt::format("<h3>{}</h3>\n", Html(section.title));
  html += SentencesHtml(section.lead);
  if (!section.table.empty()) html += section.table.ToHtml();
  html += SentencesHtml(section.sentences);
  for (const Picture& one : section.pictures) html += PictureHtml(one.svg, one.title, one.reading);
  for (const NextCommand& one : section.commands)
    html += ParagraphHtml(one.purpose + (one.purpose.ends_with('?') ? "" : ":")) + CommandHtml(one.command);
  return html;
}

}  // namespace gauntlet
