#include "cli/drawing/decomposition_drawing.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "convex/invalid_input.hpp"
#include "convex/linear_algebra/cholesky.hpp"

namespace cli {
namespace {

using convex::Index;
using convex::Vector;
using Point = Eigen::Vector2d;
using Polygon = std::vector<Point>;

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

/// The window: both ends of every arrow with room around.
struct Window {
  Point low, high;
  explicit Window(const Polygon& points) : low(points.front()), high(points.front()) {
    for (const Point& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const double room = 0.45 * std::max((high - low).maxCoeff(), 1e-9 * high.cwiseAbs().maxCoeff() + 1e-300);
    const Point middle = (low + high) / 2;
    const double half = (high - low).maxCoeff() / 2 + room;
    low = middle.array() - half;
    high = middle.array() + half;
  }
  Polygon frame() const { return {low, {high.x(), low.y()}, high, {low.x(), high.y()}}; }
  double size() const { return (high - low).maxCoeff(); }
};

std::string rows(const Polygon& points) {
  std::string text;
  for (const Point& p : points) fmt::format_to(std::back_inserter(text), "{} {}\n", p.x(), p.y());
  return text;
}

/// Draws a page: data blocks first, then what is plotted of them, and labels.
class Page {
 public:
  void add(const Polygon& points, const std::string& how) {
    if (points.empty()) return;
    fmt::format_to(std::back_inserter(blocks_), "$d{} << EOD\n{}EOD\n", count_, rows(points));
    plots_ += fmt::format("{}$d{} using 1:2 {}", count_ > 0 ? ", \\\n  " : "", count_, how);
    ++count_;
  }
  void label(const Point& p, const std::string& text, const char* where) {
    fmt::format_to(std::back_inserter(blocks_), "set label {} at {},{} {} front font \",11\"\n", quoted(text),
                   p.x(), p.y(), where);
  }
  void arrow(const Point& from, const Point& to, const char* style) {
    fmt::format_to(std::back_inserter(blocks_), "set arrow from {},{} to {},{} {} front\n", from.x(),
                   from.y(), to.x(), to.y(), style);
  }
  std::string script(const std::string& top) const { return top + blocks_ + "plot " + plots_ + "\n"; }

 private:
  std::string blocks_, plots_;
  int count_ = 0;
};

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
Polygon cone_at(const Point& x, const Polygon& generators, const Window& window) {
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
  Polygon cone{x, corners[first], corners[second]};
  cone = cut(cone, {1, 0}, window.low.x());
  cone = cut(cone, {-1, 0}, -window.high.x());
  cone = cut(cone, {0, 1}, window.low.y());
  return cut(cone, {0, -1}, -window.high.y());
}

}  // namespace

Drawing decomposition_drawing(const SolvedScene& solved) {
  const Scene& scene = solved.scene;
  const convex::NearestPointProblem& problem = scene.problem;
  if (problem.dimension() != 2)
    throw convex::InvalidInput(
        fmt::format("--plot: {} has {} coordinates; a picture needs two", scene.file, problem.dimension()));
  if (!solved.has_answer())
    throw convex::InvalidInput("--plot: " + scene.file + " has no solution to draw; leave --plot out");
  Eigen::Matrix2d A;
  A.col(0) = problem.A.multiply(Vector::Unit(2, 0));
  A.col(1) = problem.A.multiply(Vector::Unit(2, 1));
  const Point free = problem.A.solve(problem.z), x = solved.solution.primal.q;
  const mechanics::Hypothesis& hypothesis = solved.solution.hypothesis;
  Polygon shown{free, x};
  const bool has_classical = hypothesis.two_sided.consistent && hypothesis.two_sided.acceleration.size() == 2;
  Point classical = x;
  if (has_classical) classical = hypothesis.two_sided.acceleration;
  if (has_classical) shown.push_back(classical);
  shown.push_back(x + 0.3 * (x - free));
  const Window window(shown);

  Page page;
  Polygon admissible = window.frame(), generators;
  std::vector<Polygon> lines;
  for (Index a = 0; a < problem.rows(); ++a) {
    const Point u = problem.U.row(a);
    const bool held =
        std::find(problem.two_sided.begin(), problem.two_sided.end(), a) != problem.two_sided.end();
    admissible = cut(admissible, u, problem.s[a]);
    if (held) admissible = cut(admissible, -u, -problem.s[a]);
    const Point foot = u * problem.s[a] / u.squaredNorm(), along(-u.y(), u.x());
    const double reach = 4 * (window.size() + foot.norm()) / along.norm();
    lines.push_back({foot - reach * along, foot + reach * along});
    const auto& tight = solved.solution.multipliers.tight;
    if (std::find(tight.begin(), tight.end(), a) == tight.end()) continue;
    generators.push_back(-problem.A.solve(problem.U.row(a)));
    if (held) generators.push_back(problem.A.solve(problem.U.row(a)));
  }
  page.add(admissible, "with filledcurves closed fc rgb \"#d9e8f5\" notitle");
  page.add(cone_at(x, generators, window), "with filledcurves closed fc rgb \"#f7e3cf\" notitle");
  for (const Polygon& line : lines) page.add(line, "with lines lc rgb \"#0072b2\" lw 1.2 notitle");
  for (const Point& g : generators)
    page.add({x, x + 4 * window.size() * g.normalized()},
             "with lines lc rgb \"#d55e00\" dt 3 lw 1.2 notitle");
  const double radius = std::sqrt((x - free).dot(A * (x - free)));
  for (const double part : {1.0 / 3, 2.0 / 3, 1.0})
    page.add(ellipse(A, free, part * radius), "with lines lc rgb \"#888888\" lw 0.8 notitle");
  const bool moved = radius > 1e-12 * std::sqrt(free.dot(A * free) + x.dot(A * x));
  if (moved) page.arrow(free, x, "lc rgb \"#d55e00\" lw 2");
  page.add({free}, "with points pt 7 ps 0.8 lc rgb \"#000000\" notitle");
  page.add({x}, "with points pt 7 ps 1 lc rgb \"#0072b2\" notitle");
  const bool different = has_classical && (classical - x).norm() > 1e-9 * window.size();
  if (different) page.add({classical}, "with points pt 6 ps 1 lc rgb \"#cc79a7\" lw 1.5 notitle");
  if (generators.size() > 1 || moved)
    page.label(x + 1.15 * (free - x), "A⁻¹N, N the normal cone at x",
               "center offset 0,-1.2 tc rgb \"#b04a00\"");
  page.label(free, "A⁻¹z, free", "right offset -0.7,-0.4");
  page.label(x, "q'' = A⁻¹x, x = proj_C z", "left offset 0.8,0.5");
  if (moved) page.label((free + x) / 2, "A⁻¹R, R the reaction", "left offset 0.6,0 tc rgb \"#b04a00\"");
  if (different) page.label(classical, "all contacts held", "left offset 0.7,-0.4 tc rgb \"#a04f80\"");
  if (!admissible.empty()) {
    Point middle = Point::Zero();
    for (const Point& p : admissible) middle += p / static_cast<double>(admissible.size());
    page.label(middle, "A⁻¹C", "center tc rgb \"#0072b2\"");
  }
  const std::string top = fmt::format(
      "set size ratio -1\nset clip two\nset xrange [{}:{}]\nset yrange [{}:{}]\nset xlabel {}\nset ylabel "
      "{}\nset title "
      "{}\n"
      "set border lw 0.7 lc rgb \"#444444\"\nset tics font \",9\"\nunset key\n",
      window.low.x(), window.high.x(), window.low.y(), window.high.y(),
      quoted("acceleration of " + scene.coordinates[0]), quoted("acceleration of " + scene.coordinates[1]),
      quoted((scene.title.empty() ? scene.file : scene.title) + "\nellipses: circles of the kinetic metric"));
  return {page.script(top), 700};
}

}  // namespace cli
