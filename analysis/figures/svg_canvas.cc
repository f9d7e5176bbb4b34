#include "analysis/figures/svg_canvas.h"

#include <cmath>
#include <cstdint>
#include <iterator>

#include <fmt/format.h>

namespace gauntlet::analysis {
namespace {

// Length of the well-formed UTF-8 sequence at the start of `text`, 0 when there is none (Unicode 15, table
// 3-7).
std::size_t SequenceLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const auto continues = [&](std::size_t i) { return i < text.size() && (byte(i) & 0xC0) == 0x80; };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return continues(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    if (!continues(1) || !continues(2)) return 0;
    const bool overlong = first == 0xE0 && byte(1) < 0xA0;
    const bool surrogate = first == 0xED && byte(1) > 0x9F;
    // U+FFFE and U+FFFF are no XML characters.
    const bool non_character = first == 0xEF && byte(1) == 0xBF && byte(2) >= 0xBE;
    return overlong || surrogate || non_character ? 0 : 3;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    if (!continues(1) || !continues(2) || !continues(3)) return 0;
    const bool overlong = first == 0xF0 && byte(1) < 0x90;
    const bool too_large = first == 0xF4 && byte(1) > 0x8F;
    return overlong || too_large ? 0 : 4;
  }
  return 0;
}

}  // namespace

std::string EscapeXml(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = SequenceLength(text);
    const char c = text.front();
    if (length == 0) {
      out += '?';
      text.remove_prefix(1);
      continue;
    }
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
      "<title>{}</title>\n<style>\n{}</style>\n",
      w, h, w, h, EscapeXml(title), style_sheet);
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
