#include "convex/operations/operation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "convex/composite/closed_form.hpp"
#include "convex/composite/composite_prox.hpp"
#include "convex/composite/saddle_solver.hpp"
#include "convex/counted.hpp"
#include "convex/double_double.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/properness.hpp"
#include "convex/linear_quadratic/prox.hpp"
#include "convex/linear_quadratic/value.hpp"
#include "convex/operations/composed_prox.hpp"
#include "convex/operations/exact_end.hpp"
#include "convex/operations/line_prox.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/one_at_a_time.hpp"
#include "convex/operations/open_domain.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/reduction.hpp"
#include "convex/operations/tied_parts.hpp"
#include "convex/operations/two_function_max.hpp"

namespace convex::inline operations {
namespace {

/// Moving a point or covector from a part to the whole costs a few roundings of each of its terms.
constexpr double roundings_of_a_move = 4;

/// A linear or quadratic program is solved to so much of the value.
constexpr double accuracy_of_a_program = 64 * unit_roundoff;

[[noreturn]] void refuse(const FunctionNode& f, const char* what) {
  throw InvalidInput(
      f.call().name + ": its " + what +
      " needs the parts as programs, and one is known by value and prox alone; use functions of "
      "`moreau functions`");
}

/// Numbers such as 1/3 are rounded as they are read: sets that are to touch may be apart.
[[noreturn]] void refuse_nearly_met(const char* where, double apart) {
  char miss[32];
  std::snprintf(miss, sizeof miss, "%.0e", apart);
  throw InvalidInput(
      std::string(where) + ": the domains of its functions miss each other by about " + miss +
      ", which may be the rounding of the numbers written; move or widen one of them by as much");
}

/// Known to be +inf, not one that was not found.
bool is_infinite(const Value& value) { return value.value == infinity && value.error == 0; }

void take_better(std::optional<Prox>& best, Prox found) {
  if (!best || (found.x.size() > 0 && found.error_bound < best->error_bound)) best = std::move(found);
}

}  // namespace

bool is_settled(const Prox& found, const Vector& z, const Metric& W) {
  if (found.status == Status::infeasible || found.x.size() == 0) return true;
  return found.status == Status::solved &&
         found.error_bound <= accuracy_of_prox * (W.norm(z) + W.norm(found.x));
}

std::optional<Prox> by_moreau(const DualProx& dual, const Vector& z, const Metric& W) {
  const Metric V = inverse(W);
  bool known = true;
  const auto from = [&](const Vector& point) {
    std::optional<Prox> part = dual(point, V);
    known = known && part;
    if (!part || part->x.size() == 0) return part ? *part : Prox{};
    Prox turned = moved(*part, part->v, part->x, part->error_bound, z, W);
    if (part->values) turned.values = turned_round(*part->values);
    return turned;
  };
  Prox whole = reduced(W.multiply(z), z, W, from, [](const Vector& r) { return r; });
  if (!known) return std::nullopt;
  whole.by_conjugate = true;
  return whole;
}

double unit_of_slope(double slope) {
  return slope > 0 && std::isfinite(slope) ? std::exp2(std::floor(std::log2(slope))) : 1;
}

std::optional<Prox> prox_in_slopes(const Operation& f, double first, const Vector& z, const Metric& W,
                                   const Look& look) {
  constexpr int most_slopes = 3;
  constexpr double far_off = 1024;  // so far above the slopes, or below them, a unit hides what is missed
  std::optional<Prox> best;
  double slope = unit_of_slope(first);
  for (int pass = 0; pass < most_slopes; ++pass) {
    const auto form = f.graph(z.size(), slope);
    if (!form) return std::nullopt;
    Prox found = convex::prox(*form, z, W, look);
    const bool by_point = form->by_point && !form->by_slope;
    const double actual = by_point ? found.x.norm() : f.slope_of(found.v);
    // In a unit far above the slopes a miss in a height is rounding and moves x. Points have no normals of
    // sets in them: in a unit far below them the multipliers of heights are hidden too.
    const double unit = std::abs(slope);
    const bool hidden = unit > far_off * std::max(actual, 1.0) || (by_point && actual > far_off * unit);
    const bool better = !best || found.error_bound < best->error_bound;
    if (better && (!hidden || !best)) best = std::move(found);
    if (!hidden && (best->status == Status::solved || best->status == Status::infeasible)) break;
    const double next = by_point ? -unit_of_slope(actual) : unit_of_slope(actual);
    if (std::abs(next) == unit || !(form->by_slope || form->by_point)) break;
    slope = next;
    if (hidden && pass + 1 < most_slopes) best.reset();
  }
  return best;
}

std::optional<Prox> Operation::other_prox(const Vector& z, const Metric& W, const Look& look) const {
  if (facts().piecewise_quadratic) return std::nullopt;
  if (z.size() == 1)
    if (auto found = line_prox(self(), z[0], W.diagonal()[0])) return found;
  const std::vector<Function> parts = maximum_of();
  return parts.empty() ? std::nullopt : prox_of_max(parts, z, W, look);
}

Function indicator_of_point(const Vector& p) {
  const Index n = p.size();
  return named("affine", {argument("A", Matrix(Matrix::Identity(n, n))), argument("b", p)}, n);
}

Value Operation::evaluate(const Vector& x) const { return by_program(x).value; }

Operation::ByProgram Operation::by_program(const Vector& x) const {
  const double length = x.stableNorm();           // whose square may be no double
  if (facts().support && length == 0) return {};  // of whatever set, 0
  // Positively homogeneous: the solvers see the point at the size of 1, and the slopes are the same there.
  const bool homogeneous = facts().support && length > 0;
  const double size = homogeneous ? std::exp2(std::floor(std::log2(length))) : 1;
  const Vector at = x / size;
  if (const auto form = linear_quadratic(x.size())) {
    WorkLimit::count(WorkLimit::of_a_program_value);
    const linear_quadratic::Evaluation found = linear_quadratic::evaluate(*form, at);
    if (found.status == Status::solved && std::isinf(found.value) && !facts().finite)
      return {{found.value, 0}, {}};
    if (found.status == Status::solved && !std::isnan(found.value)) {
      const double rounding = accuracy_of_a_program * std::abs(found.value);
      return {multiple_of(size, {found.value, found.error + rounding}), found.v};
    }
  }
  if (const auto form = graph(x.size())) {
    GraphValue found = convex::evaluate(*form, at);
    // Heights in units of the slope there may show what others hide.
    const double unit = found.v ? unit_of_slope(found.v->norm()) : 1;
    if (form->by_slope && found.status != Status::solved && unit != 1) {
      GraphValue other = convex::evaluate(*graph(x.size(), unit), at);
      if (other.status == Status::solved || value_of(other).error < value_of(found).error)
        found = std::move(other);
    }
    Value value = multiple_of(size, value_of(found));
    // Tiny numbers may look apart to a program.
    if (std::isinf(value.value) && facts().finite) value = {infinity, infinity};
    return {value, found.v, size * found.w};
  }
  refuse(*this, "value");
}

std::optional<Prox> Operation::own_prox(const Vector& z, const Metric& W, const Look& look) const {
  std::optional<Prox> best = reduced_prox(z, W, look);
  if (best && is_settled(*best, z, W)) return best;
  if (auto whole = prox_by_entries(*this, z, W, look)) {
    take_better(best, *std::move(whole));
    if (is_settled(*best, z, W)) return best;
  }
  if (const auto form = linear_quadratic(z.size()))
    take_better(best, linear_quadratic::prox(*form, z, W));
  else if (auto program = prox_in_slopes(*this, 1, z, W, look))
    take_better(best, *std::move(program));
  else if (const auto plain = graph(z.size()))
    take_better(best, convex::prox(*plain, z, W, look));
  return best;
}

Prox Operation::prox_by_all_ways(const Vector& z, const Metric& W, const Look& look) const {
  // A maximum has another way, by its dual, which is left as much work as its programs may take.
  const bool is_maximum = !facts().piecewise_quadratic && !maximum_of().empty();
  std::optional<Prox> best = [&] {
    if (!is_maximum) return own_prox(z, W, look);
    const auto part = WorkLimit::half_of_the_rest();
    return own_prox(z, W, look);
  }();
  if (!best) refuse(*this, "prox in this metric");
  if (WorkLimit::passed()) return *std::move(best);
  // Of a far z a program's x may lie outside by its rounding, where f rises without end, as 1/x at 0.
  const bool is_outside = [&] {
    if (z.size() != 1 || best->x.size() != 1 || !is_settled(*best, z, W) || facts().piecewise_quadratic)
      return false;
    const auto part = WorkLimit::half_of_the_rest();  // a least value is looked for to its last digit
    return is_infinite(evaluate(best->x));
  }();
  if (is_outside || !is_settled(*best, z, W))
    if (auto other = other_prox(z, W, look)) {
      if (is_outside) best.reset();
      take_better(best, *std::move(other));
    }
  const OneAtATime question(OneAtATime::Kind::conjugate_prox);
  if (is_settled(*best, z, W) || !question.first()) return *std::move(best);
  const Function g = conjugate();
  const auto* dual = dynamic_cast<const Operation*>(&g.node());
  if (dual && primal_of(g)) return *std::move(best);
  // A conjugate of numbers that had to be rounded is that of another function, which no residual sees.
  if (!is_diagonal_kind(W) && has_rounded_numbers(g.call())) return *std::move(best);
  const auto of_dual = [&](const Vector& point, const Metric& V) {
    return dual ? dual->own_prox(point, V, look) : std::optional(g.prox(point, V, look));
  };
  if (auto other = by_moreau(of_dual, z, W)) take_better(best, *std::move(other));
  return *std::move(best);
}

Prox Operation::prox(const Vector& z, const Metric& W, const Look& look) const {
  Prox found = prox_by_all_ways(z, W, look);
  if (found.x.size() != z.size()) return found;
  const double doubt = doubt_of_ties(self(), found.x, W);
  found.error_bound += doubt;
  if (found.status == Status::solved && doubt > accuracy_of_prox * (W.norm(z) + W.norm(found.x)))
    found.status = Status::inaccurate;
  return found;
}

std::optional<Vector> Operation::subgradient(const Vector& x) const {
  if (const auto form = linear_quadratic(x.size())) return linear_quadratic::evaluate(*form, x).v;
  if (const auto form = graph(x.size())) return convex::evaluate(*form, x).v;
  refuse(*this, "subgradient");
}

std::optional<Prox> prox_by_program(const Function& f, const Vector& z, const Metric& W, const Look& look) {
  if (const auto form = f.node().linear_quadratic(z.size())) return linear_quadratic::prox(*form, z, W);
  if (const auto form = f.node().graph(z.size())) return convex::prox(*form, z, W, look);
  return std::nullopt;
}

Function Operation::conjugate() const { return computed_conjugate(self()); }

Prox moved(Prox part, Vector x, Vector v, double bound, const Vector& z, const Metric& W) {
  return moved(std::move(part), std::move(x), std::move(v), bound, z, W, W);
}

Prox moved(Prox part, Vector x, Vector v, double bound, const Vector& z, const Metric& W, const Metric& V) {
  if (part.status == Status::infeasible || part.x.size() == 0) return part;
  part.error_bound = bound + V.dual_norm(stationarity(z, W, x, v)) + rounding_of_a_move(z, x, v, W);
  part.values.reset();
  part.x = std::move(x);
  part.v = std::move(v);
  return part;
}

double rounding_of_a_move(const Vector& z, const Vector& x, const Vector& v, const Metric& W) {
  return roundings_of_a_move * unit_roundoff * (W.norm(z) + W.norm(x) + W.dual_norm(v));
}

Prox with_values(Prox whole, const std::optional<PairOfValues>& of_part, const Value& f_more,
                 const Value& v_more) {
  if (of_part) whole.values = {sum_of(of_part->f_x, f_more), sum_of(of_part->f_v, v_more), of_part->miss};
  return whole;
}

Value product(const Vector& a, const Vector& b) {
  RunningSum sum;
  for (Index i = 0; i < a.size(); ++i) sum.add(two_product(a[i], b[i]));
  const double value = sum.value(), roundings = 2.0 * static_cast<double>(a.size() + 1) * unit_roundoff;
  return {value, unit_roundoff * (std::abs(value) + roundings * a.cwiseAbs().dot(b.cwiseAbs()))};
}

void require_fit(const Function& f, const Vector& c, const char* where, const char* name) {
  const std::string start = std::string(where) + "(" + name + "): ";
  if (c.size() == 0) throw InvalidInput(start + "no entries; give at least one");
  if (f.dimension() != 0 && c.size() != f.dimension())
    throw InvalidInput(start + counted(c.size(), "entry", "entries") + ", the function takes " +
                       std::to_string(f.dimension()) + "; give as many");
  f.node().require_size(c.size());
  if (!c.allFinite()) throw InvalidInput(start + "an entry is not finite; give finite numbers");
}

void require_positive(double number, const char* where, const char* name) {
  if (!(number > 0) || !std::isfinite(number))
    throw InvalidInput(std::string(where) + "(" + name +
                       "): not positive and finite; give a finite number above 0");
}

std::optional<Interval> domain_of_one(const Function& f) {
  const Vector right = Vector::Ones(1);
  const double high = f.node().domain_support(right), low = -f.node().domain_support(-right);
  if (std::isnan(high) || std::isnan(low)) return std::nullopt;
  return Interval{low, high};
}

void require_proper(const Function& f, Index n, const char* where) {
  const auto refuse_empty = [&] {
    throw InvalidInput(std::string(where) +
                       ": no point has all its functions finite; give functions whose domains meet");
  };
  if (f.facts().finite) return;
  const WorkLimit question;
  const bool by_entry = n == 1 || (f.dimension() == 0 && f.facts().separable);
  if (const auto domain = by_entry ? domain_of_one(f) : std::nullopt) {
    if (domain->low == infinity || domain->high == -infinity) refuse_empty();  // beyond all numbers
    const double apart = domain->low - domain->high;
    if (apart > 0 && apart <= membership_tolerance * std::max(std::abs(domain->low), std::abs(domain->high)))
      refuse_nearly_met(where, apart);
    if (apart > 0 || (apart == 0 && std::isinf(f(Vector::Constant(1, domain->low))))) refuse_empty();
  }
  if (const auto form = f.node().linear_quadratic(n)) {
    if (properness(*form) == linear_quadratic::Defect::empty_domain && exact_end(f, n) != ProgramEnd::minimum)
      refuse_empty();
  } else if (auto graph = f.node().graph(n)) {
    // Terms that are finite everywhere leave the domain as it is, and would only pull at the gap.
    std::erase_if(graph->terms, [](const GraphTerm& term) { return term.f->facts().finite; });
    if (has_empty_open_domain(*graph) || domains_apart(*graph)) refuse_empty();
    if (prox(*graph, Vector::Zero(n), Metric::identity(n)).status == Status::infeasible) refuse_empty();
  }
}

}  // namespace convex::inline operations
