#include "analysis/figures/svg_canvas.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "base/utf8.h"

namespace gauntlet::analysis {
namespace {

// What all pictures have in common.
constexpr std::string_view kStyleSheet =
    R"(text { font-family: 'DejaVu Sans', Verdana, Helvetica, Arial, sans-serif; font-size: 13px; fill: #22272e; }
.title { font-size: 23px; font-weight: bold; }
.outcome { font-size: 17px; font-weight: bold; }
.subtitle { font-size: 13px; fill: #5b6470; text-anchor: end; }
.heading { font-size: 11.5px; font-weight: bold; letter-spacing: 1.2px; fill: #5b6470; }
.rule { stroke: #d5d9de; stroke-width: 1; }
.axis { font-size: 12px; fill: #5b6470; }
.tick { stroke: #5b6470; stroke-width: 1; }
)";

// U+FFFE and U+FFFF, the last two, are no XML characters.
constexpr std::pair<std::string_view, std::string_view> kEscapes[] = {
    {"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"},           {"\"", "&quot;"},       {"\t", " "},
    {"\n", " "},    {"\r", " "},   {"\xef\xbf\xbe", "???"}, {"\xef\xbf\xbf", "???"}};

std::string_view Escaped(std::string_view character) {
  for (const auto& [plain, escaped] : kEscapes) {
    if (character == plain) return escaped;
  }
  return character.size() == 1 && static_cast<std::uint8_t>(character[0]) < 0x20 ? "?" : character;
}

std::string PointsText(const std::vector<Pixel>& points) {
  std::string text;
  for (const Pixel& p : points) {
    text += fmt::format("{}{},{}", text.empty() ? "" : " ", SvgNumber(p.x), SvgNumber(p.y));
  }
  return text;
}

}  // namespace

std::string EscapeXml(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = Utf8Length(text, 0);
    out += length == 0 ? "?" : Escaped(text.substr(0, length));
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

std::string SvgNumber(double value) {
  if (!std::isfinite(value)) return "0";
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

SvgCanvas::SvgCanvas(double width, double height, std::string_view title, std::string_view style_sheet) {
  const std::string w = SvgNumber(width);
  const std::string h = SvgNumber(height);
  out_ += fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\">\n"
      "<title>{}</title>\n<style>\n{}{}</style>\n",
      w, h, w, h, EscapeXml(title), kStyleSheet, style_sheet);
  Rectangle({0, 0}, width, height, "fill=\"#ffffff\"");
}

void SvgCanvas::OpenGroup(std::string_view style) {
  out_ += fmt::format("<g {}>\n", style);
}

void SvgCanvas::CloseGroup() {
  out_ += "</g>\n";
}

void SvgCanvas::Line(Pixel a, Pixel b, std::string_view style) {
  out_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n", SvgNumber(a.x), SvgNumber(a.y),
                      SvgNumber(b.x), SvgNumber(b.y), style);
}

void SvgCanvas::Polyline(const std::vector<Pixel>& points, std::string_view style) {
  out_ += fmt::format("<polyline points=\"{}\" {}/>\n", PointsText(points), style);
}

void SvgCanvas::Polygon(const std::vector<Pixel>& points, std::string_view style) {
  out_ += fmt::format("<polygon points=\"{}\" {}/>\n", PointsText(points), style);
}

void SvgCanvas::Circle(Pixel center, double radius, std::string_view style) {
  out_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", SvgNumber(center.x), SvgNumber(center.y),
                      SvgNumber(radius), style);
}

void SvgCanvas::Rectangle(Pixel corner, double width, double height, std::string_view style) {
  out_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>\n", SvgNumber(corner.x),
                      SvgNumber(corner.y), SvgNumber(width), SvgNumber(height), style);
}

void SvgCanvas::Text(Pixel baseline, std::string_view text, std::string_view style) {
  out_ += fmt::format("<text x=\"{}\" y=\"{}\" {}>{}</text>\n", SvgNumber(baseline.x), SvgNumber(baseline.y),
                      style, EscapeXml(text));
}

std::string SvgCanvas::Take() {
  out_ += "</svg>\n";
  return std::move(out_);
}

}  // namespace gauntlet::analysis
