#include "convex/decompositions/cutting_planes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "convex/composite/metric_difference.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/sum.hpp"

namespace convex::inline decompositions {
namespace {

constexpr Index most_entries = 16;

/// A value less the height of a line is right to so many roundings of their terms.
constexpr double roundings_of_a_cut = 16;

/// Lines f(x_i) - f(x_0) + v_i·(d - d_i) below f(x_0 + d) - f(x_0), and half-spaces that hold the domain.
struct Cuts {
  std::vector<Vector> slopes, normals;
  std::vector<double> heights, levels;

  Index count() const { return std::ssize(slopes); }
  void add(const Vector& v, double height) {
    slopes.push_back(v);
    heights.push_back(height);
  }
  void add_half_space(const Vector& normal, double level) {
    normals.push_back(normal);
    levels.push_back(level);
  }
  double at(const Vector& d) const {
    double most = -INFINITY;
    for (std::size_t i = 0; i < slopes.size(); ++i) most = std::max(most, slopes[i].dot(d) + heights[i]);
    return most;
  }
  Function model() const {
    std::vector<Function> terms;
    if (!slopes.empty()) terms.push_back(max_affine(rows_of(slopes), entries_of(heights)));
    if (!normals.empty()) terms.push_back(indicator(polyhedron(rows_of(normals), entries_of(levels))));
    return terms.size() == 1 ? terms[0] : proper_sum(terms);
  }

 private:
  static Matrix rows_of(const std::vector<Vector>& rows) {
    Matrix made(std::ssize(rows), rows.front().size());
    for (Index i = 0; i < made.rows(); ++i) made.row(i) = rows[static_cast<std::size_t>(i)].transpose();
    return made;
  }
  static Vector entries_of(const std::vector<double>& entries) {
    return Eigen::Map<const Vector>(entries.data(), std::ssize(entries));
  }
};

}  // namespace

std::optional<Prox> at_kink(const Function& f, const std::optional<Prox>& near, const Vector& z,
                            const Metric& W, double stiffness, const Look& look) {
  constexpr Index most_cuts = 24;
  constexpr double part_moved = 1e-8;  // farther away parts of f are no lines
  if (!near || near->x.size() != z.size() || z.size() > most_entries || f.facts().smooth) return std::nullopt;
  const Vector& x_0 = near->x;
  const Value f_0 = f.evaluate(x_0);
  if (!std::isfinite(f_0.value) || !std::isfinite(f_0.error)) return std::nullopt;
  const Vector pull = -metric_difference(W, x_0, z);  // of z on x_0
  const Metric stiff = W.scaled(stiffness);
  const Vector aim = refined_solve(stiff, pull);
  const double farthest = part_moved * (W.norm(z) + W.norm(x_0));
  Cuts cuts;
  Prox made = *near;
  for (bool is_least = false; cuts.count() < most_cuts && !WorkLimit::passed();) {
    const std::optional<Vector> v = f.subgradient(made.x);
    const Value here = f.evaluate(made.x);
    if (!v || v->size() != z.size() || !v->allFinite() || !std::isfinite(here.value)) return std::nullopt;
    const Vector moved = made.x - x_0;
    // x itself is rounded, where f is steep.
    const double rounding =
        here.error + f_0.error +
        roundings_of_a_cut * unit_roundoff * (std::abs(here.value) + v->cwiseAbs().dot(made.x.cwiseAbs()));
    if (is_least && here.value - f_0.value - cuts.at(moved) <= rounding) {
      made.error_bound += W.norm(moved) + W.dual_norm(metric_difference(W, made.x, z) + made.v);
      made.values.reset();
      return made;
    }
    cuts.add(*v, here.value - f_0.value - v->dot(moved));
    const Prox step = cuts.model().prox(aim, stiff, look);
    if (step.x.size() != z.size() || !step.x.allFinite()) return std::nullopt;
    // Of one part alone the least point is far away: the next part is met on the way.
    const double length = W.norm(step.x);
    is_least = length <= farthest;
    const Vector within = is_least ? step.x : Vector(farthest / length * step.x);
    made.x = x_0 + within;
    made.v = pull - W.multiply(within);
  }
  return std::nullopt;
}

namespace {

/// Where f was seen: at x_0 + d, its value there less the first one, and the error of the difference.
struct Seen {
  Vector d, v;
  double height = 0, error = 0;

  double line(const Vector& at) const { return height + v.dot(at - d); }
};

/// The search for the least f + ½||. - z||² by cuts.
class SearchByCuts {
 public:
  SearchByCuts(const Function& f, const Vector& x_0, const Vector& z, const Metric& W, const Look& look)
      : f_(f), x_0_(x_0), W_(W), look_(look), aim_(z - x_0), pull_(-metric_difference(W, x_0, z)) {}

  std::optional<Prox> run(double enough) {
    constexpr Index most_cuts = 200;
    constexpr double well_within = 0.25;
    Vector d = Vector::Zero(x_0_.size());
    if (!look_towards(d)) return std::nullopt;
    while (cuts_.count() + std::ssize(cuts_.normals) < most_cuts && !WorkLimit::passed()) {
      WorkLimit::count(WorkLimit::of_a_program);
      const Prox step = cuts_.model().prox(aim_, W_, look_);
      if (step.x.size() != aim_.size() || !step.x.allFinite()) break;
      d = (x_0_ + step.x) - x_0_;
      const std::size_t seen = seen_.size();
      if (!look_towards(d)) break;
      if (seen_.size() > seen && note(step, enough) && best_->error_bound <= well_within * enough) break;
    }
    return best_;
  }

 private:
  /// Sees f at x_0 + d, or where that is outside of its domain at a point nearer to what was seen; false
  /// where it cannot be seen.
  bool look_towards(const Vector& d) {
    constexpr int most_halvings = 40;
    if (see(d)) return true;
    Vector beside = d;
    if (const auto nearest = into_domain(d)) {
      if (see(*nearest)) return true;
      beside = *nearest;
    }
    for (int halving = 0; !seen_.empty() && halving < most_halvings && !WorkLimit::passed(); ++halving) {
      beside = lowest_ + 0.5 * (beside - lowest_);
      if (see(beside)) return true;
    }
    return false;
  }

  bool see(const Vector& d) {
    const Vector u = x_0_ + d;
    const Value here = f_.evaluate(u);
    if (!std::isfinite(here.value) || !std::isfinite(here.error)) return false;
    const std::optional<Vector> v = f_.subgradient(u);
    if (!v || v->size() != u.size() || !v->allFinite()) return false;
    if (seen_.empty()) first_ = here;
    const double terms = std::abs(here.value) + std::abs(first_.value) + v->cwiseAbs().dot(u.cwiseAbs());
    const Seen made{d, *v, here.value - first_.value,
                    here.error + first_.error + roundings_of_a_cut * unit_roundoff * terms};
    if (seen_.empty() || objective(made) < least_) {
      least_ = objective(made);
      lowest_ = d;
    }
    // A line above a value elsewhere is that of no subgradient, by as much.
    for (const Seen& other : seen_) {
      const double errors = made.error + other.error;
      widened_ = std::max(
          {widened_, other.line(d) - made.height - errors, made.line(other.d) - other.height - errors});
    }
    seen_.push_back(made);
    cuts_.add(made.v, made.height - made.v.dot(d));
    return true;
  }

  double objective(const Seen& at) const { return at.height - pull_.dot(at.d) + 0.5 * W_.inner(at.d, at.d); }

  /// The nearest point of a set; beyond it a half-space holds all of it. The prox of another function,
  /// however stiff, is no projection: points of its domain lie beyond, where it is larger.
  std::optional<Vector> into_domain(const Vector& d) {
    if (!f_.facts().indicator) return std::nullopt;
    const Vector u = x_0_ + d;
    const Prox nearest = f_.prox(u, W_, look_);
    if (nearest.x.size() != u.size() || !nearest.x.allFinite()) return std::nullopt;
    const Vector normal = metric_difference(W_, u, nearest.x);
    const double length = W_.dual_norm(normal);
    const double off = nearest.error_bound;
    if (!(length > off)) return std::nullopt;
    const Vector inside = nearest.x - x_0_, unit = normal / length;
    cuts_.add_half_space(unit, unit.dot(inside) + off);
    return inside;
  }

  /// The point just seen, as the one that the lines without it led to. False where it is no better.
  bool note(const Prox& step, double enough) {
    const Seen& here = seen_.back();
    if (seen_.size() < 2 || step.v.size() != here.d.size()) return false;
    double below = -INFINITY;
    for (std::size_t i = 0; i + 1 < seen_.size(); ++i) below = std::max(below, seen_[i].line(here.d));
    const double above = here.height - below;
    double error = here.error;
    for (std::size_t i = 0; i + 1 < seen_.size(); ++i)
      if (seen_[i].line(here.d) >= below - std::abs(above) - seen_[i].error)
        error = std::max(error, seen_[i].error);
    const double missed = W_.dual_norm(step.v - pull_ + W_.multiply(here.d));
    // A set holds a point that its rounding leaves outside, and lines know of no price for that.
    const Vector x = x_0_ + here.d;
    const double outside = f_.facts().indicator ? unit_roundoff * step.v.cwiseAbs().dot(x.cwiseAbs()) : 0;
    const double open = 2 * error + widened_ + outside;
    if (!(std::sqrt(std::max(above, 0.0) + open) + missed <= enough)) return false;
    // The lines' own conjugate says what f* is at most, however the least above them was found: a rounding of
    // x may be much on a steep line.
    const Value most = cuts_.model().conjugate().evaluate(step.v);
    const Value along = product(step.v, here.d);
    const double left =
        std::max(0.0, here.height + most.value - along.value) + most.error + along.error + open;
    Prox made;
    made.x = x;
    made.v = step.v;
    made.error_bound = std::sqrt(left) + missed;
    if (!(made.error_bound <= enough) || (best_ && best_->error_bound <= made.error_bound)) return false;
    made.route = ProxRoute::iterative;
    made.method = "cutting planes";
    // f*(v) <= x_0·v - f(x_0) + what the lines' conjugate is.
    const Value shift = product(made.v, x_0_);
    made.values = {{first_.value + here.height, error}, sum_of(shift, {most.value - first_.value, left}), 0};
    best_ = std::move(made);
    return true;
  }

  const Function& f_;
  const Vector& x_0_;
  const Metric& W_;
  const Look& look_;
  Vector aim_, pull_;
  Cuts cuts_;
  std::vector<Seen> seen_;
  Vector lowest_;
  double least_ = 0, widened_ = 0;
  Value first_;
  std::optional<Prox> best_;
};

}  // namespace

std::optional<Prox> prox_by_cuts(const Function& f, const Vector& x_0, const Vector& z, const Metric& W,
                                 double enough, const Look& look) {
  if (z.size() > most_entries || x_0.size() != z.size() || !x_0.allFinite()) return std::nullopt;
  return SearchByCuts(f, x_0, z, W, look).run(enough);
}

}  // namespace convex::inline decompositions
