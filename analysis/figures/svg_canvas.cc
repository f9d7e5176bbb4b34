#include "analysis/figures/svg_canvas.h"

#include <cmath>
#include <cstdint>
#include <iterator>

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

// U+FFFE and U+FFFF are no XML characters.
bool IsNonCharacter(std::string_view sequence) {
  return sequence == "\xef\xbf\xbe" || sequence == "\xef\xbf\xbf";
}

}  // namespace

std::string EscapeXml(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = Utf8Length(text, 0);
    if (length == 0) {
      out += '?';
      text.remove_prefix(1);
      continue;
    }
    if (IsNonCharacter(text.substr(0, length))) {
      out += "???";
      text.remove_prefix(length);
      continue;
    }
    const char c = text.front();
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        if (length == 1 && static_cast<std::uint8_t>(c) < 0x20) {
          out += c == '\t' || c == '\n' || c == '\r' ? ' ' : '?';
        } else {
          out += text.substr(0, length);
        }
    }
    text.remove_prefix(length);
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
  fmt::format_to(
      std::back_inserter(out_),
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\">\n"
      "<title>{}</title>\n<style>\n{}{}</style>\n",
      w, h, w, h, EscapeXml(title), kStyleSheet, style_sheet);
  Rectangle({0, 0}, width, height, "fill=\"#ffffff\"");
}

void SvgCanvas::OpenGroup(std::string_view style) {
  fmt::format_to(std::back_inserter(out_), "<g {}>\n", style);
}

void SvgCanvas::CloseGroup() {
  out_ += "</g>\n";
}

void SvgCanvas::Line(Pixel a, Pixel b, std::string_view style) {
  fmt::format_to(std::back_inserter(out_), "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n",
                 SvgNumber(a.x), SvgNumber(a.y), SvgNumber(b.x), SvgNumber(b.y), style);
}

void SvgCanvas::Points(const std::vector<Pixel>& points) {
  bool first = true;
  for (const Pixel& p : points) {
    if (!first) out_ += ' ';
    first = false;
    out_ += SvgNumber(p.x);
    out_ += ',';
    out_ += SvgNumber(p.y);
  }
}

void SvgCanvas::Polyline(const std::vector<Pixel>& points, std::string_view style) {
  out_ += "<polyline points=\"";
  Points(points);
  fmt::format_to(std::back_inserter(out_), "\" {}/>\n", style);
}

void SvgCanvas::Polygon(const std::vector<Pixel>& points, std::string_view style) {
  out_ += "<polygon points=\"";
  Points(points);
  fmt::format_to(std::back_inserter(out_), "\" {}/>\n", style);
}

void SvgCanvas::Circle(Pixel center, double radius, std::string_view style) {
  fmt::format_to(std::back_inserter(out_), "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", SvgNumber(center.x),
                 SvgNumber(center.y), SvgNumber(radius), style);
}

void SvgCanvas::Rectangle(Pixel corner, double width, double height, std::string_view style) {
  fmt::format_to(std::back_inserter(out_), "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>\n",
                 SvgNumber(corner.x), SvgNumber(corner.y), SvgNumber(width), SvgNumber(height), style);
}

void SvgCanvas::Text(Pixel baseline, std::string_view text, std::string_view style) {
  fmt::format_to(std::back_inserter(out_), "<text x=\"{}\" y=\"{}\" {}>{}</text>\n", SvgNumber(baseline.x),
                 SvgNumber(baseline.y), style, EscapeXml(text));
}

std::string SvgCanvas::Take() {
  out_ += "</svg>\n";
  return std::move(out_);
}

}  // namespace gauntlet::analysis
