#include "cli/drawing/decomposition_drawing.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "cli/drawing/labelled_page.hpp"
#include "cli/drawing/plane_section.hpp"
#include "cli/report/verdict_text.hpp"
#include "convex/linear_algebra/cholesky.hpp"

namespace cli {
namespace {

using convex::Index;
using convex::Vector;

/// The part of the polygon where a·p >= b (Sutherland and Hodgman 1974).
Polygon cut(const Polygon& polygon, const Point& a, double b) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point &p = polygon[k], &next = polygon[(k + 1) % polygon.size()];
    const double here = a.dot(p) - b, there = a.dot(next) - b;
    if (here >= 0) kept.push_back(p);
    if ((here > 0 && there < 0) || (here < 0 && there > 0))
      kept.push_back(p + here / (here - there) * (next - p));
  }
  return kept;
}

/// {p : (p - centre)·A(p - centre) = radius²}.
Polygon ellipse(const Eigen::Matrix2d& A, const Point& centre, double radius) {
  constexpr int corners = 180;
  convex::Matrix circle(2, corners + 1);
  for (int k = 0; k <= corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    circle.col(k) = Point(std::cos(angle), std::sin(angle));
  }
  convex::linear_algebra::Cholesky(A).solve_upper_in_place(circle);
  Polygon points;
  for (int k = 0; k <= corners; ++k) points.push_back(centre + radius * circle.col(k));
  return points;
}

/// The cone at x of directions d with n_k·d >= 0 as its two edges say, cut to the window.
Polygon cone_at(const Point& x, const Polygon& generators, const PageWindow& window) {
  Polygon corners;
  const double far = 4 * window.size();
  for (const Point& g : generators) corners.push_back(x + far * g.normalized());
  if (corners.size() < 2) return {};
  // The two generators that are farthest apart span the cone.
  std::size_t first = 0, second = 1;
  double least = 2;
  for (std::size_t i = 0; i < generators.size(); ++i)
    for (std::size_t j = i + 1; j < generators.size(); ++j) {
      const double cosine = generators[i].normalized().dot(generators[j].normalized());
      if (cosine < least) {
        least = cosine;
        first = i;
        second = j;
      }
    }
  // Where the two nearly oppose each other, the chord between them would cut the cone off in the window.
  const Point between = generators[first].normalized() + generators[second].normalized();
  Polygon cone{x, corners[first], corners[second]};
  if (between.norm() > 0) cone.insert(cone.begin() + 2, x + far * between.normalized());
  cone = cut(cone, {1, 0}, window.low.x());
  cone = cut(cone, {-1, 0}, -window.high.x());
  cone = cut(cone, {0, 1}, window.low.y());
  return cut(cone, {0, -1}, -window.high.y());
}

/// The part of the line u·p = s that the window shows; empty when none.
Polygon visible_part(const PlaneSection::Row& row, const PageWindow& window) {
  const Polygon frame = window.frame();
  Polygon ends;
  for (std::size_t k = 0; k < frame.size(); ++k) {
    const Point &p = frame[k], &next = frame[(k + 1) % frame.size()];
    const double here = row.u.dot(p) - row.s, there = row.u.dot(next) - row.s;
    if ((here < 0) != (there < 0)) ends.push_back(p + here / (here - there) * (next - p));
  }
  return ends.size() == 2 ? ends : Polygon{};
}

Polygon along(const Polygon& line) {
  Polygon points;
  for (const double part : {0.08, 0.92, 0.2, 0.8, 0.35, 0.65, 0.5})
    points.push_back(line[0] + part * (line[1] - line[0]));
  return points;
}

/// The window's size where free and true motion are one: that of the lines, as long as the farthest is not
/// much farther than the nearest; that of the acceleration where there is none.
double fallback_size(const PlaneSection& section) {
  constexpr double much = 6;
  double nearest = 0, farthest = 0;
  for (const PlaneSection::Row& row : section.rows) {
    const double distance = std::abs(row.u.dot(section.truth) - row.s) / row.u.norm();
    if (distance > 0 && (nearest == 0 || distance < nearest)) nearest = distance;
    farthest = std::max(farthest, distance);
  }
  if (nearest == 0) nearest = farthest = section.truth.norm();
  return nearest > 0 ? 1.3 * std::min(farthest, much * nearest) : 1;
}

struct Words {
  const char *cone = "A⁻¹N, N the normal cone at x", *free = "A⁻¹z, free",
             *truth = "q'' = A⁻¹x, x = proj_C z", *reaction = "A⁻¹R, R the reaction", *allowed = "A⁻¹C";
};

void draw_rows(LabelledPage& page, const SolvedScene& solved, const PlaneSection& section,
               const PageWindow& window, std::vector<std::string>& elsewhere) {
  std::vector<std::pair<Polygon, std::string>> named;
  for (const Index row : section.without_line) elsewhere.push_back(solved.scene.contact_name(row));
  for (const PlaneSection::Row& row : section.rows) {
    const Polygon line = visible_part(row, window);
    const std::string& name = solved.scene.contact_name(row.row);
    if (line.empty())
      elsewhere.push_back(name);
    else {
      page.line(line, "with lines lc rgb \"#0072b2\" lw 1.2 notitle");
      named.emplace_back(along(line), name);
    }
  }
  for (const auto& [anchors, name] : named)
    if (!page.label(anchors, name, "#00507d")) elsewhere.push_back(name);
}

std::string heading_of(const SolvedScene& solved, const PlaneSection& section, bool ellipses,
                       const std::vector<std::string>& elsewhere) {
  const Scene& scene = solved.scene;
  std::string text = scene.title.empty() ? scene.file : scene.title;
  std::string below;
  const auto say = [&](const std::string& words) { below += (below.empty() ? "" : "; ") + words; };
  if (scene.problem.dimension() > 2)
    say("plane of " + scene.coordinates[static_cast<std::size_t>(section.axes[0])] + "'' and " +
        scene.coordinates[static_cast<std::size_t>(section.axes[1])] + "'', the rest held");
  if (ellipses) say("ellipses: circles of the kinetic metric");
  text = heading_line(text) + (below.empty() ? "" : "\n" + heading_line(below));
  return text +
         (elsewhere.empty() ? "" : "\n" + heading_line("outside of the picture: " + listed(elsewhere)));
}

}  // namespace

Drawing decomposition_drawing(const SolvedScene& solved, const std::optional<std::string>& plane,
                              PageArea area) {
  const Scene& scene = solved.scene;
  const PlaneSection section = plane_section(solved, plane);
  const Point &free = section.free, &x = section.truth;
  const double radius = std::sqrt((x - free).dot(section.A * (x - free)));
  const double size = std::sqrt(free.dot(section.A * free) + x.dot(section.A * x));
  const bool moved = radius > 1e-12 * size;
  Polygon shown{free, x};
  if (moved) shown.push_back(x + 0.3 * (x - free));
  // The classical motion is shown where it does not shrink all else.
  constexpr double farthest = 4;
  const bool different =
      section.classical && (*section.classical - x).norm() > 1e-9 * std::max((x - free).norm(), size);
  const bool near = different && (*section.classical - x).norm() <=
                                     farthest * (moved ? (x - free).norm() : fallback_size(section));
  if (near) shown.push_back(*section.classical);
  const PageWindow window(shown, fallback_size(section));

  LabelledPage page(window, area);
  Polygon admissible = window.frame(), generators;
  for (const PlaneSection::Row& row : section.rows) {
    admissible = cut(admissible, row.u, row.s);
    if (row.two_sided) admissible = cut(admissible, -row.u, -row.s);
    if (!row.tight) continue;
    const Point normal = Point(section.A(1, 1) * row.u.x() - section.A(0, 1) * row.u.y(),
                               section.A(0, 0) * row.u.y() - section.A(1, 0) * row.u.x());
    generators.push_back(-normal);
    if (row.two_sided) generators.push_back(normal);
  }
  const Words words;
  page.add(admissible, "with filledcurves closed fc rgb \"#d9e8f5\" notitle");
  page.add(cone_at(x, generators, window), "with filledcurves closed fc rgb \"#f7e3cf\" notitle");
  if (moved)
    for (const double part : {1.0 / 3, 2.0 / 3, 1.0})
      page.line(ellipse(section.A, free, part * radius), "with lines lc rgb \"#888888\" lw 0.8 notitle");
  std::vector<std::string> elsewhere;
  for (const Point& g : generators) {
    const Point end = x + 4 * window.size() * g.normalized();
    page.line({x, end}, "with lines lc rgb \"#d55e00\" dt 3 lw 1.2 notitle");
  }
  if (moved) page.arrow(free, x, "lc rgb \"#d55e00\" lw 2");
  if (moved) page.point(free, "with points pt 7 ps 0.8 lc rgb \"#000000\" notitle");
  page.point(x, "with points pt 7 ps 1 lc rgb \"#0072b2\" notitle");
  if (near) page.point(*section.classical, "with points pt 6 ps 1 lc rgb \"#cc79a7\" lw 1.5 notitle");
  draw_rows(page, solved, section, window, elsewhere);
  page.label({x}, moved ? words.truth : "q'' = A⁻¹x = A⁻¹z, the free motion", "#000000");
  if (moved) page.label({free}, words.free, "#000000");
  if (near) page.label({*section.classical}, "all contacts held", "#a04f80");
  if (moved) page.label({(free + x) / 2, (2 * free + x) / 3, (free + 2 * x) / 3}, words.reaction, "#b04a00");
  if (!generators.empty()) {
    Polygon inside;
    Point middle = Point::Zero();
    for (const Point& g : generators) middle += g.normalized();
    // Within the cone; of one ray, where the reaction does not lie on it.
    if (generators.size() == 1 && moved)
      for (const double part : {0.2, 0.35, 0.5, 0.1}) inside.push_back(free + part * (free - x));
    for (const double part : {0.3, 0.4, 0.5, 0.6, 0.2})
      if (inside.size() < 4 && middle.norm() > 1e-9)
        inside.push_back(x + part * window.size() * middle.normalized());
    if (inside.empty())
      for (const Point& g : generators) inside.push_back(x + 0.25 * window.size() * g.normalized());
    page.label(inside, words.cone, "#b04a00");
  }
  if (admissible.size() > 2) {
    Point middle = Point::Zero();
    for (const Point& p : admissible) middle += p / static_cast<double>(admissible.size());
    page.label({middle, (2 * middle + x) / 3}, words.allowed, "#00507d");
  }
  return {page.script("acceleration of " + scene.coordinates[static_cast<std::size_t>(section.axes[0])],
                      "acceleration of " + scene.coordinates[static_cast<std::size_t>(section.axes[1])],
                      heading_of(solved, section, moved, elsewhere)),
          page_size, area.page_width};
}

}  // namespace cli
