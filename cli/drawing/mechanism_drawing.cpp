#include "cli/drawing/mechanism_drawing.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include "cli/drawing/contact_arrows.hpp"
#include "cli/drawing/decomposition_drawing.hpp"
#include "cli/report/readable_numbers.hpp"
#include "cli/report/text_table.hpp"
#include "cli/report/verdict_text.hpp"

namespace cli::inline drawings {
namespace {

using convex::Index;
using convex::Vector;

Polygon drawn_circle(const Point& centre, double radius) {
  constexpr int corners = 90;
  Polygon points;
  for (int k = 0; k <= corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    points.push_back(centre + radius * Point(std::cos(angle), std::sin(angle)));
  }
  return points;
}

/// The corners of a shape, as what is drawn of it.
Polygon outline(const DrawnScene::Shape& shape, const Vector& values) {
  const auto place = [&](std::size_t k) {
    return Point(values[shape.numbers[k]], values[shape.numbers[k + 1]]);
  };
  switch (shape.kind) {
    case DrawnShape::Kind::point:
      return {place(0)};
    case DrawnShape::Kind::segment:
      return {place(0), place(2)};
    case DrawnShape::Kind::circle:
      return drawn_circle(place(0), values[shape.numbers[2]]);
  }
  return {};
}

/// The multipliers as the table has them.
Vector multipliers_of(const SolvedScene& solved) {
  Vector lambda = solved.scene.over_constraints(solved.solution.multipliers.least_norm);
  const Vector readable = readable_numbers(solved, most_rows).lambda;
  lambda.head(readable.size()) = readable;
  return lambda;
}

}  // namespace

Drawing mechanism_drawing(const SolvedScene& solved, const DrawnScene& drawn, PageArea area) {
  const Scene& scene = solved.scene;
  const Vector values = drawn.values(scene.state);
  Polygon all;
  std::vector<Polygon> outlines;
  for (const DrawnScene::Shape& shape : drawn.shapes()) {
    outlines.push_back(outline(shape, values));
    all.insert(all.end(), outlines.back().begin(), outlines.back().end());
  }
  const Vector lambda = multipliers_of(solved);
  const std::vector<ContactArrow> arrows =
      ContactArrows(*scene.system, drawn).at(scene.state, values, lambda).arrows;
  double longest = 0;
  for (const ContactArrow& arrow : arrows)
    longest = std::max(longest, std::hypot(arrow.force[0], arrow.force[1]));
  // Of the mechanism's size; and around it, where its labels stand.
  constexpr double longest_part = 0.4, room = 0.15;
  const double a_unit = longest > 0 ? longest_part * PageWindow(all, 1, 0).size() / longest : 0;
  for (const ContactArrow& arrow : arrows)
    all.emplace_back(arrow.at[0] + a_unit * arrow.force[0], arrow.at[1] + a_unit * arrow.force[1]);
  const PageWindow window(all, 1, room);
  LabelledPage page(window, area);
  for (std::size_t k = 0; k < outlines.size(); ++k) {
    if (drawn.shapes()[k].kind == DrawnShape::Kind::point)
      page.point(outlines[k].front(), "with points pt 7 ps 0.9 lc rgb \"#222222\" notitle");
    else
      page.line(outlines[k], "with lines lc rgb \"#222222\" lw 2.2 notitle");
  }
  for (const ContactArrow& arrow : arrows) {
    const Point at(arrow.at[0], arrow.at[1]), force(arrow.force[0], arrow.force[1]);
    // The dot shows where a force is that is too small for an arrow.
    page.point(at, "with points pt 7 ps 0.5 lc rgb \"#d55e00\" notitle");
    page.arrow(at, at + a_unit * force, "lc rgb \"#d55e00\" lw 2");
  }
  std::set<Index> named;
  std::vector<std::string> without_room, without_place, without_force;
  for (const ContactArrow& arrow : arrows) {
    if (!named.insert(arrow.constraint).second) continue;  // the second of a pair is as long
    const Point at(arrow.at[0], arrow.at[1]), force(arrow.force[0], arrow.force[1]);
    const Point step = a_unit * force;
    const std::string label =
        scene.constraints[static_cast<std::size_t>(arrow.constraint)] + " " + number_text(force.norm());
    if (!page.label({at + step, at + step / 2, at}, {label}, "#b04a00")) without_room.push_back(label);
  }
  for (const Index a : scene.contacts) {
    const std::string& name = scene.constraints[static_cast<std::size_t>(a)];
    if (lambda[a] == 0)
      without_force.push_back(name);
    else if (named.count(a) == 0)
      without_place.push_back(name + " (lambda " + number_text(lambda[a]) + ")");
  }
  std::vector<std::string> below;
  if (!arrows.empty()) below.emplace_back("arrows, numbers: forces, as far as they work on their place");
  if (!without_room.empty()) below.push_back("no room for " + listed(without_room));
  if (!without_place.empty()) below.push_back("on no place that is drawn: " + listed(without_place));
  if (!without_force.empty()) below.push_back("without force: " + listed(without_force));
  std::string title = heading_line(scene.title.empty() ? scene.file : scene.title, area.title_room());
  if (!below.empty()) title += "\n" + heading_lines(below, area.title_room());
  return page.drawing("across, in the units of the file", "up, in the units of the file", title);
}

Drawing scene_drawing(const SolvedScene& solved, const DrawnScene& drawn,
                      const std::optional<std::string>& plane) {
  if (drawn.shapes().empty() || !solved.has_answer()) return page_of({decomposition_drawing(solved, plane)});
  if (solved.scene.problem.dimension() < 2) return page_of({mechanism_drawing(solved, drawn, {})});
  constexpr int both = 2 * page_size;
  return page_of(
      {mechanism_drawing(solved, drawn, {0, both}), decomposition_drawing(solved, plane, {page_size, both})});
}

}  // namespace cli::inline drawings
