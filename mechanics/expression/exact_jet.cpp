#include "mechanics/expression/exact_jet.hpp"

#include <cmath>

namespace mechanics::expression {
namespace {

using convex::Integer;

/// f(a, b) with its partials.
struct ExactPartials {
  Fraction f, a, b, aa, ab, bb;
};

const Fraction zero{}, one{1, 1};

bool is_zero(const Fraction& x) { return convex::sign(x) == 0; }

/// Larger exponents make numbers that nobody wants to wait for.
constexpr std::int64_t largest_exponent = 64;

Fraction raised(const Fraction& base, std::int64_t exponent) {
  Fraction result = one;
  for (std::int64_t k = 0; k < std::abs(exponent); ++k) result = result * base;
  return exponent < 0 ? one / result : result;
}

std::optional<ExactPartials> power(const Fraction& a, const Fraction& b) {
  if (!(b.denominator == 1) || !b.numerator.fits_word()) return std::nullopt;
  const std::int64_t e = b.numerator.word();
  if (std::abs(e) > largest_exponent || (is_zero(a) && e < 0)) return std::nullopt;
  ExactPartials p{raised(a, e), zero, zero, zero, zero, zero};
  if (e != 0) p.a = Fraction{e, 1} * raised(a, e - 1);
  if (e != 0 && e != 1) p.aa = Fraction{e * (e - 1), 1} * raised(a, e - 2);
  return p;
}

/// The root of a square.
std::optional<Fraction> exact_root(const Fraction& a) {
  const double root = std::sqrt(convex::nearest_double(a));
  if (!std::isfinite(root)) return std::nullopt;
  // Numerator and denominator of a in lowest terms are squares themselves.
  const Fraction lowest = convex::lowest_terms(a);
  constexpr double largest = 0x1p52;
  const double p = std::sqrt(convex::nearest_quotient(lowest.numerator, 1));
  const double q = std::sqrt(convex::nearest_quotient(lowest.denominator, 1));
  if (!(p < largest && q < largest)) return std::nullopt;
  const Fraction candidate{static_cast<std::int64_t>(p), static_cast<std::int64_t>(q)};
  if (!(candidate * candidate == lowest)) return std::nullopt;
  return candidate;
}

/// Functions of one operand at the one point where they and their derivatives are whole numbers.
std::optional<ExactPartials> at_whole_point(Operation operation, const Fraction& a) {
  const bool at_zero = is_zero(a);
  switch (operation) {
    case Operation::sin:
    case Operation::tan:
    case Operation::asin:
    case Operation::atan:
    case Operation::sinh:
    case Operation::tanh:
      if (at_zero) return ExactPartials{zero, one, zero, zero, zero, zero};
      break;
    case Operation::cos:
      if (at_zero) return ExactPartials{one, zero, zero, -one, zero, zero};
      break;
    case Operation::cosh:
      if (at_zero) return ExactPartials{one, zero, zero, one, zero, zero};
      break;
    case Operation::exp:
      if (at_zero) return ExactPartials{one, one, zero, one, zero, zero};
      break;
    case Operation::log:
      if (a == one) return ExactPartials{zero, one, zero, -one, zero, zero};
      break;
    default:
      break;
  }
  return std::nullopt;
}

std::optional<ExactPartials> partials(Operation operation, const Fraction& a, const Fraction& b,
                                      bool b_is_constant) {
  switch (operation) {
    case Operation::negate:
      return ExactPartials{-a, -one, zero, zero, zero, zero};
    case Operation::add:
      return ExactPartials{a + b, one, one, zero, zero, zero};
    case Operation::subtract:
      return ExactPartials{a - b, one, -one, zero, zero, zero};
    case Operation::multiply:
      return ExactPartials{a * b, b, a, zero, one, zero};
    case Operation::divide: {
      if (is_zero(b)) return std::nullopt;
      const Fraction f = a / b, inverse = one / b;
      return ExactPartials{
          f, inverse, -f * inverse, zero, -inverse * inverse, Fraction{2, 1} * f * inverse * inverse};
    }
    case Operation::power:
      return b_is_constant ? power(a, b) : std::nullopt;
    case Operation::sqrt: {
      if (convex::sign(a) <= 0) return std::nullopt;
      const auto root = exact_root(a);
      if (!root) return std::nullopt;
      const Fraction slope = one / (Fraction{2, 1} * *root);
      return ExactPartials{*root, slope, zero, -slope / (Fraction{2, 1} * a), zero, zero};
    }
    case Operation::abs:
      if (is_zero(a)) return std::nullopt;
      return convex::sign(a) > 0 ? ExactPartials{a, one, zero, zero, zero, zero}
                                 : ExactPartials{-a, -one, zero, zero, zero, zero};
    case Operation::sign:
      if (is_zero(a)) return std::nullopt;
      return ExactPartials{{convex::sign(a), 1}, zero, zero, zero, zero, zero};
    default:
      return at_whole_point(operation, a);
  }
}

/// c x + d y, entry by entry.
std::vector<Fraction> combined(const Fraction& c, const std::vector<Fraction>& x, const Fraction& d,
                               const std::vector<Fraction>& y) {
  const bool from_x = !x.empty() && !is_zero(c), from_y = !y.empty() && !is_zero(d);
  std::vector<Fraction> sum(from_x ? x.size() : from_y ? y.size() : 0);
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (from_x && !is_zero(x[i])) sum[i] = c * x[i];
    if (from_y && !is_zero(y[i])) sum[i] = sum[i] + d * y[i];
  }
  return sum;
}

void widen(std::vector<Fraction>& x, std::size_t size) {
  if (x.empty()) x.resize(size);
}

/// sum_ij += c x_i y_j.
void add_product(std::vector<Fraction>& sum, const Fraction& c, const std::vector<Fraction>& x,
                 const std::vector<Fraction>& y) {
  if (is_zero(c) || x.empty() || y.empty()) return;
  widen(sum, x.size() * y.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < y.size(); ++j)
      if (!is_zero(x[i]) && !is_zero(y[j])) sum[i * y.size() + j] = sum[i * y.size() + j] + c * x[i] * y[j];
}

ExactJet chained(const ExactPartials& p, const ExactJet& a, const ExactJet& b) {
  ExactJet f;
  f.value = p.f;
  f.along = p.a * a.along + p.b * b.along;
  f.along_twice = p.a * a.along_twice + p.b * b.along_twice + p.aa * a.along * a.along +
                  Fraction{2, 1} * p.ab * a.along * b.along + p.bb * b.along * b.along;
  f.by_q = combined(p.a, a.by_q, p.b, b.by_q);
  f.by_v = combined(p.a, a.by_v, p.b, b.by_v);
  // ∂(Df)/∂v: the second derivatives with D on one side.
  const Fraction with_a = p.aa * a.along + p.ab * b.along, with_b = p.ab * a.along + p.bb * b.along;
  const std::vector<Fraction> first = combined(p.a, a.along_by_v, p.b, b.along_by_v);
  f.along_by_v = combined(one, first, one, combined(with_a, a.by_v, with_b, b.by_v));
  f.by_vv = combined(p.a, a.by_vv, p.b, b.by_vv);
  add_product(f.by_vv, p.aa, a.by_v, a.by_v);
  add_product(f.by_vv, p.ab, a.by_v, b.by_v);
  add_product(f.by_vv, p.ab, b.by_v, a.by_v);
  add_product(f.by_vv, p.bb, b.by_v, b.by_v);
  return f;
}

}  // namespace

std::optional<Fraction> literal_value(const Tape& tape, NodeId node) {
  return convex::read_fraction(tape.text(node));
}

ExactJet ExactEvaluation::variable(NodeId node) const {
  ExactJet jet;
  const std::size_t n = state_->q.size(), i = tape_->a(node);
  switch (tape_->operation(node)) {
    case Operation::coordinate:
      jet.value = state_->q[i];
      jet.along = state_->v[i];
      widen(jet.by_q, n);
      jet.by_q[i] = one;
      break;
    case Operation::velocity:
      jet.value = state_->v[i];
      widen(jet.by_v, n);
      jet.by_v[i] = one;
      break;
    default:
      jet.value = state_->t;
      jet.along = one;
  }
  return jet;
}

std::optional<ExactJet> ExactEvaluation::evaluated(NodeId node) const {
  switch (const Operation operation = tape_->operation(node)) {
    case Operation::literal: {
      const auto value = literal_value(*tape_, node);
      if (!value) return std::nullopt;
      ExactJet jet;
      jet.value = convex::lowest_terms(*value);
      return jet;
    }
    case Operation::pi:
      return std::nullopt;
    case Operation::coordinate:
    case Operation::velocity:
    case Operation::time:
      return variable(node);
    case Operation::parameter:
      return *known_[tape_->a(node)];
    default: {
      const auto& a = *known_[tape_->a(node)];
      const auto& b = arity(operation) == 2 ? *known_[tape_->b(node)] : a;
      if (!a || !b) return std::nullopt;
      const auto p = partials(operation, a->value, b->value, tape_->is_constant(tape_->b(node)));
      if (!p) return std::nullopt;
      return arity(operation) == 2 ? chained(*p, *a, *b) : chained(*p, *a, ExactJet{});
    }
  }
}

const std::optional<ExactJet>& ExactEvaluation::operator()(NodeId root) {
  known_.resize(tape_->size());
  std::vector<NodeId> open{root};
  while (!open.empty()) {
    const NodeId node = open.back();
    if (known_[node]) {
      open.pop_back();
      continue;
    }
    const Operation operation = tape_->operation(node);
    const bool is_leaf = arity(operation) == 0;
    const std::size_t before = open.size();
    if (!is_leaf && !known_[tape_->a(node)]) open.push_back(tape_->a(node));
    if (arity(operation) == 2 && !known_[tape_->b(node)]) open.push_back(tape_->b(node));
    if (open.size() > before) continue;
    known_[node] = evaluated(node);
    open.pop_back();
  }
  return *known_[root];
}

}  // namespace mechanics::expression
