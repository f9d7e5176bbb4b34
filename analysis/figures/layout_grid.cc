#include "analysis/figures/layout_grid.h"

#include <fmt/format.h>

#include "analysis/figures/arena_drawing.h"
#include "analysis/figures/figure_frame.h"
#include "analysis/figures/svg_canvas.h"
#include "sim/arena/arena.h"

namespace gauntlet::analysis {
namespace {

constexpr double kScale = 0.22;  // of a run's picture
// Pixels.
constexpr double kLeft = 120.0;   // names of the rows
constexpr double kTop = 84.0;     // title and outcome
constexpr double kBottom = 60.0;  // names of the columns
constexpr double kGap = 10.0;
constexpr double kCaption = 22.0;  // below each picture

std::string StyleSheet() {
  return fmt::format(R"({}.place {{ fill: {}; fill-opacity: 0.75; stroke: #ffffff; stroke-width: 4; }}
.cell {{ fill: #f7f7f8; stroke: #d8dce1; }}
.caption {{ font-size: 12px; fill: {}; text-anchor: middle; }}
.column {{ font-size: 13px; fill: {}; text-anchor: middle; }}
.row {{ font-size: 13px; fill: {}; text-anchor: end; }}
)",
                     ArenaStyleSheet(), kLostColor, kInk, kSoftInk, kSoftInk);
}

// Where the cells lie on the page.
class GridFrame {
 public:
  explicit GridFrame(const LayoutGrid& grid)
      : rows_(static_cast<double>(grid.rows.size())), columns_(static_cast<double>(grid.columns.size())) {
    const FigureFrame frame(grid.arena);
    width_ = kScale * 2 * frame.half_x() * frame.scale();
    height_ = kScale * 2 * frame.half_y() * frame.scale();
  }

  double width() const { return width_; }    // pixels, of an arena
  double height() const { return height_; }  // pixels, of an arena
  Pixel CornerOf(std::size_t column, std::size_t row) const {
    return {kLeft + static_cast<double>(column) * (width_ + kGap),
            kTop + (rows_ - 1.0 - static_cast<double>(row)) * Step()};
  }
  double page_width() const { return kLeft + columns_ * (width_ + kGap) + kGap; }
  double bottom() const { return kTop + rows_ * Step(); }

 private:
  double Step() const { return height_ + kCaption + kGap; }

  double rows_;
  double columns_;
  double width_ = 0.0;
  double height_ = 0.0;
};

void DrawLayout(SvgCanvas& canvas, const LayoutGrid& grid, const GridLayout& layout, const GridFrame& cells) {
  const Pixel corner = cells.CornerOf(layout.column, layout.row);
  const FigureFrame frame(grid.arena);
  sim::TestCase shown = grid.arena;
  shown.obstacles = layout.obstacles;
  const sim::Arena arena(shown);
  canvas.OpenGroup(fmt::format("transform=\"translate({} {}) scale({})\"",
                               SvgNumber(corner.x - kScale * FigureFrame::kLeft),
                               SvgNumber(corner.y - kScale * FigureFrame::kTop), kScale));
  DrawFloor(canvas, frame, arena);
  DrawObstacles(canvas, frame, arena);
  if (layout.place) canvas.Circle(frame.At(*layout.place), 22.0, "class=\"place\"");
  canvas.CloseGroup();
  canvas.Text({corner.x + cells.width() / 2, corner.y + cells.height() + 16}, layout.caption,
              "class=\"caption\"");
}

void DrawNames(SvgCanvas& canvas, const LayoutGrid& grid, const GridFrame& cells) {
  for (std::size_t column = 0; column < grid.columns.size(); ++column) {
    const double middle = cells.CornerOf(column, 0).x + cells.width() / 2;
    canvas.Text({middle, cells.bottom() + 14}, grid.columns[column], "class=\"column\"");
  }
  for (std::size_t row = 0; row < grid.rows.size(); ++row) {
    const double middle = cells.CornerOf(0, row).y + cells.height() / 2;
    canvas.Text({kLeft - 12, middle + 5}, grid.rows[row], "class=\"row\"");
  }
  canvas.Text({(kLeft + cells.page_width()) / 2, cells.bottom() + 40}, grid.across_name, "class=\"column\"");
  canvas.Text({kLeft - 12, kTop - 8}, grid.up_name, "class=\"row\"");
}

}  // namespace

std::string DrawLayoutGrid(const LayoutGrid& grid) {
  const GridFrame cells(grid);
  SvgCanvas canvas(cells.page_width(), cells.bottom() + kBottom, grid.title, StyleSheet());
  canvas.Text({24, 34}, grid.title, "class=\"title\"");
  canvas.Text({24, 58}, grid.outcome, "class=\"axis\"");
  for (std::size_t column = 0; column < grid.columns.size(); ++column) {
    for (std::size_t row = 0; row < grid.rows.size(); ++row) {
      canvas.Rectangle(cells.CornerOf(column, row), cells.width(), cells.height(), "class=\"cell\"");
    }
  }
  for (const GridLayout& layout : grid.layouts) DrawLayout(canvas, grid, layout, cells);
  DrawNames(canvas, grid, cells);
  return canvas.Take();
}

}  // namespace gauntlet::analysis
