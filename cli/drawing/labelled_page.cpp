#include "cli/drawing/labelled_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cli/drawing/gnuplot.hpp"

namespace cli::inline drawings {
namespace {

/// Pixels of the square of numbers in the picture, and of letters.
constexpr double frame_left = 92, frame_size = 580, frame_bottom = 56, label_size = 11.5;

/// Points of letters, and of the numbers at the axes.
constexpr double label_points = 11, axis_points = 9, title_points = 11;

/// Pixels, of a line of the title beyond the second.
constexpr double title_line = 15;

/// As far as both edges of the picture are from the middle of the frame.
constexpr double line_of_title = 2 * (page_size - frame_left - frame_size / 2) - 12;

std::string number_rows(const Polygon& points, const Point& unit) {
  std::string text;
  for (const Point& p : points) text += fmt::format("{} {}\n", p.x() * unit.x(), p.y() * unit.y());
  return text;
}

}  // namespace

double PageArea::title_room() const { return line_of_title / std::sqrt(letters()); }

PageWindow::PageWindow(const Polygon& points, double otherwise, double room)
    : low(points.front()), high(points.front()) {
  for (const Point& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  double size = (high - low).maxCoeff();
  if (!(size > 1e-9 * otherwise)) size = otherwise;
  const Point middle = (low + high) / 2;
  const double half = (0.5 + room) * size;
  low = middle.array() - half;
  high = middle.array() + half;
}

PagePoint PageWindow::pixel(const Point& p) const {
  return PagePoint(frame_left, frame_bottom) + frame_size / size() * (p - low);
}

LabelledPage::LabelledPage(const PageWindow& window, PageArea area, Point unit)
    : window_(window),
      area_(area),
      unit_(std::move(unit)),
      labels_({frame_left, frame_bottom}, {frame_left + frame_size, frame_bottom + frame_size}) {}

void LabelledPage::add(const Polygon& points, const std::string& how) {
  if (points.empty()) return;
  // Of two pictures on one page each has data of its own.
  const std::string name = fmt::format("$d{}_{}", area_.left, count_);
  blocks_ += fmt::format("{} << EOD\n{}EOD\n", name, number_rows(points, unit_));
  plots_ += fmt::format("{}{} using 1:2 {}", count_ > 0 ? ", \\\n  " : "", name, how);
  ++count_;
}

std::vector<PagePoint> LabelledPage::pixels(const Polygon& points) const {
  std::vector<PagePoint> made;
  for (const Point& p : points) made.push_back(window_.pixel(p));
  return made;
}

void LabelledPage::line(const Polygon& points, const std::string& how) {
  add(points, how);
  labels_.avoid_line(pixels(points));
}

void LabelledPage::faint_line(const Polygon& points, const std::string& how) {
  add(points, how);
  labels_.avoid_line(pixels(points), true);
}

void LabelledPage::point(const Point& p, const std::string& how) {
  add({p}, how);
  constexpr double radius = 5;
  labels_.avoid_point(window_.pixel(p), radius);
}

void LabelledPage::arrow(const Point& from, const Point& to, const char* style) {
  blocks_ += fmt::format("set arrow from {},{} to {},{} {} front\n", from.x() * unit_.x(),
                         from.y() * unit_.y(), to.x() * unit_.x(), to.y() * unit_.y(), style);
  labels_.avoid_line({window_.pixel(from), window_.pixel(to)});
}

bool LabelledPage::label(const Polygon& anchors, const std::vector<std::string>& texts, const char* tint) {
  const auto placed = labels_.place(pixels(anchors), texts, label_size * area_.letters());
  if (!placed) return false;
  blocks_ +=
      fmt::format("set label {} at graph {},{} {} front font \",{:g}\" tc rgb \"{}\"\n", quoted(placed->text),
                  (placed->at.x() - frame_left) / frame_size, (placed->at.y() - frame_bottom) / frame_size,
                  placed->aligned, label_points * area_.letters(), tint);
  return true;
}

Drawing LabelledPage::drawing(const std::string& x, const std::string& y, const std::string& title) const {
  Drawing made;
  made.script =
      fmt::format(
          "unset label\nunset arrow\nset lmargin at screen {}\nset rmargin at screen {}\nset clip two\nset "
          "xrange [{}:{}]\nset yrange [{}:{}]\nset xlabel {} font \",{:g}\"\nset ylabel {} font "
          "\",{:g}\"\nset title {} font \",{:g}\" offset 0,-0.4\nset border lw 0.7 lc rgb \"#444444\"\nset "
          "tics font \",{:g}\"\nunset key\n",
          across(frame_left), across(frame_left + frame_size), window_.low.x() * unit_.x(),
          window_.high.x() * unit_.x(), window_.low.y() * unit_.y(), window_.high.y() * unit_.y(), quoted(x),
          label_points * area_.letters(), quoted(y), label_points * area_.letters(), quoted(title),
          title_points * std::sqrt(area_.letters()), axis_points * area_.letters()) +
      blocks_ + "plot " + plots_ + "\n";
  const auto more = std::max<std::ptrdiff_t>(0, std::count(title.begin(), title.end(), '\n') - 1);
  made.height = page_size +
                static_cast<int>(std::ceil(title_line * std::sqrt(area_.letters()))) * static_cast<int>(more);
  made.width = area_.page_width;
  return made;
}

Drawing page_of(const std::vector<Drawing>& pictures) {
  Drawing page;
  for (const Drawing& picture : pictures) {
    page.height = std::max(page.height, picture.height);
    page.width = picture.width;
    page.script += picture.script;
  }
  if (pictures.size() > 1) page.script = "set multiplot\n" + page.script + "unset multiplot\n";
  page.script = fmt::format("set bmargin at screen {}\nset tmargin at screen {}\n",
                            frame_bottom / page.height, (frame_bottom + frame_size) / page.height) +
                page.script;
  return page;
}

}  // namespace cli::inline drawings
