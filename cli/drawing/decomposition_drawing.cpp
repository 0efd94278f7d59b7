#include "cli/drawing/decomposition_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "cli/drawing/labelled_page.hpp"
#include "cli/drawing/plane_section.hpp"
#include "cli/report/verdict_text.hpp"
#include "convex/linear_algebra/cholesky.hpp"

namespace cli::inline drawings {
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

/// The part of the polygon in the window.
Polygon in_window(Polygon polygon, const PageWindow& window) {
  polygon = cut(polygon, {1, 0}, window.low.x());
  polygon = cut(polygon, {-1, 0}, -window.high.x());
  polygon = cut(polygon, {0, 1}, window.low.y());
  return cut(polygon, {0, -1}, -window.high.y());
}

/// x + the cone of all nonnegative combinations, cut to the window: the complement of the widest angle
/// between neighbouring generators. Empty where it has no area.
Polygon cone_at(const Point& x, const Polygon& generators, const PageWindow& window) {
  constexpr double turn = 2 * std::numbers::pi, half_turn = std::numbers::pi, rounding = 1e-9;
  std::vector<double> angles;
  for (const Point& g : generators) angles.push_back(std::atan2(g.y(), g.x()));
  std::sort(angles.begin(), angles.end());
  double widest = 0, begin = 0;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const bool is_last = k + 1 == angles.size();
    const double gap = (is_last ? angles.front() + turn : angles[k + 1]) - angles[k];
    if (gap <= widest + rounding) continue;
    widest = gap;
    begin = angles[k] + gap;
  }
  if (widest < half_turn - rounding && !angles.empty()) return window.frame();  // they span the plane
  const double opening = turn - widest;
  const bool is_line = std::all_of(angles.begin(), angles.end(), [&](double angle) {
    return std::abs(std::sin(angle - begin)) < rounding;
  });
  if (is_line) return {};
  const double far = 4 * window.size();
  Polygon cone{x};
  for (const double part : {0.0, 0.5, 1.0}) {
    const double angle = begin + part * opening;
    cone.push_back(x + far * Point(std::cos(angle), std::sin(angle)));
  }
  return in_window(std::move(cone), window);
}

/// The accelerations of the plane that the rows allow, up to rounding, cut to the window. Where they have no
/// area the two that are farthest apart: a part of a line; one where they are a point.
Polygon admissible_part(const PlaneSection& section, const PageWindow& window) {
  constexpr double rounding = 1e-7, thin = 1e-5, short_part = 1e-3;
  Polygon kept = window.frame();
  for (const PlaneSection::Row& row : section.rows) {
    const double slack = rounding * window.size() * row.u.norm();
    kept = cut(kept, row.u, row.s - slack);
    if (row.two_sided) kept = cut(kept, -row.u, -row.s - slack);
  }
  if (kept.empty()) return kept;
  double area = 0, longest = -1;
  Polygon ends{kept.front(), kept.front()};
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Point &p = kept[i], &next = kept[(i + 1) % kept.size()];
    area += p.x() * next.y() - p.y() * next.x();
    for (std::size_t j = i + 1; j < kept.size(); ++j)
      if ((p - kept[j]).norm() > longest) {
        longest = (p - kept[j]).norm();
        ends = {p, kept[j]};
      }
  }
  if (std::abs(area) > thin * window.size() * window.size()) return kept;
  return longest > short_part * window.size() ? ends : Polygon{ends.front()};
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
  std::vector<std::string> cone{"A⁻¹N, N the normal cone at x", "A⁻¹N"}, free{"A⁻¹z, free", "A⁻¹z"},
      truth{"q'' = A⁻¹x, x = proj_C z", "q'' = A⁻¹x"}, all_free{"q'' = A⁻¹x = A⁻¹z, the free motion"},
      reaction{"A⁻¹R, R the reaction", "A⁻¹R"}, allowed{"A⁻¹C"}, held{"all contacts held"};
};

void draw_rows(LabelledPage& page, const SolvedScene& solved, const PlaneSection& section,
               const PageWindow& window, std::vector<std::string>& elsewhere) {
  std::vector<std::pair<Polygon, std::string>> named;
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
    if (!page.label(anchors, {name}, "#00507d")) elsewhere.push_back(name);
}

std::string heading_of(const SolvedScene& solved, const PlaneSection& section,
                       const std::vector<std::string>& notes, const std::vector<std::string>& elsewhere,
                       PageArea area) {
  const bool is_beside = area.page_width > page_size;
  const Scene& scene = solved.scene;
  std::vector<std::string> below;
  if (scene.problem.dimension() > 2)
    below.push_back("plane of " + scene.coordinates[static_cast<std::size_t>(section.axes[0])] + "'' and " +
                    scene.coordinates[static_cast<std::size_t>(section.axes[1])] + "'', the rest held");
  below.insert(below.end(), notes.begin(), notes.end());
  // Beside the mechanism, which has its name.
  if (is_beside && below.empty()) below.emplace_back("accelerations");
  if (!elsewhere.empty()) below.push_back("outside of the picture: " + listed(elsewhere));
  std::vector<std::string> unseen;
  for (const Index row : section.without_line) unseen.push_back(scene.contact_name(row));
  if (!unseen.empty())
    below.push_back((unseen.size() == 1 ? "does" : "do") + (" not show in this plane: " + listed(unseen)));
  const std::string name = heading_line(scene.title.empty() ? scene.file : scene.title, area.title_room());
  const std::string lines = heading_lines(below, area.title_room());
  return is_beside ? lines : name + (below.empty() ? "" : "\n" + lines);
}

/// One unit of the first acceleration is as long as one of the second times this, in the kinetic metric: a
/// length and an angle have no scale in common, and kinetic energy gives them one.
Point metric_unit(const PlaneSection& section) { return {1, std::sqrt(section.A(0, 0) / section.A(1, 1))}; }

PlaneSection in_units(PlaneSection section, const Point& unit) {
  section.A = unit.asDiagonal() * section.A * unit.asDiagonal();
  section.free = section.free.cwiseQuotient(unit);
  section.truth = section.truth.cwiseQuotient(unit);
  if (section.classical) section.classical = section.classical->cwiseQuotient(unit);
  for (PlaneSection::Row& row : section.rows) row.u = row.u.cwiseProduct(unit);
  return section;
}

}  // namespace

Drawing decomposition_drawing(const SolvedScene& solved, const std::optional<std::string>& plane,
                              PageArea area) {
  const Scene& scene = solved.scene;
  const PlaneSection asked = plane_section(solved, plane);
  const Point unit = metric_unit(asked);
  const PlaneSection section = in_units(asked, unit);
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

  LabelledPage page(window, area, unit);
  const Polygon admissible = admissible_part(section, window);
  Polygon generators;
  for (const PlaneSection::Row& row : section.rows) {
    if (!row.tight) continue;
    const Point normal = Point(section.A(1, 1) * row.u.x() - section.A(0, 1) * row.u.y(),
                               section.A(0, 0) * row.u.y() - section.A(1, 0) * row.u.x());
    generators.push_back(-normal);
    if (row.two_sided) generators.push_back(normal);
  }
  const Words words;
  if (admissible.size() > 2) page.add(admissible, "with filledcurves closed fc rgb \"#d9e8f5\" notitle");
  page.add(cone_at(x, generators, window), "with filledcurves closed fc rgb \"#f7e3cf\" notitle");
  if (admissible.size() == 2) page.add(admissible, "with lines lc rgb \"#a9cbe8\" lw 7 notitle");
  if (moved)
    for (const double part : {1.0 / 3, 2.0 / 3, 1.0})
      page.faint_line(ellipse(section.A, free, part * radius),
                      "with lines lc rgb \"#888888\" lw 0.8 notitle");
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
  page.label({x}, moved ? words.truth : words.all_free, "#000000");
  if (moved) page.label({free}, words.free, "#000000");
  if (near) page.label({*section.classical}, words.held, "#a04f80");
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
  if (admissible.size() > 1) {
    Point middle = Point::Zero();
    for (const Point& p : admissible) middle += p / static_cast<double>(admissible.size());
    page.label({middle, (2 * middle + x) / 3}, words.allowed, "#00507d");
  }
  std::vector<std::string> notes;
  constexpr double round = 1e-9;
  if (moved)
    notes.emplace_back(std::abs(section.A(0, 1)) <= round * section.A(0, 0)
                           ? "circles: those of the kinetic metric"
                           : "ellipses: circles of the kinetic metric");
  if (admissible.size() == 1) notes.emplace_back("A⁻¹C is the point q'' alone");
  return page.drawing("acceleration of " + scene.coordinates[static_cast<std::size_t>(section.axes[0])],
                      "acceleration of " + scene.coordinates[static_cast<std::size_t>(section.axes[1])],
                      heading_of(solved, section, notes, elsewhere, area));
}

}  // namespace cli::inline drawings
