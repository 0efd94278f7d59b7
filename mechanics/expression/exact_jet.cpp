#include "mechanics/expression/exact_jet.hpp"

namespace mechanics::expression {
namespace {

const Number zero{}, one{1}, two{2};

bool is_zero(const Number& x) { return x.is_zero(); }

/// c x + d y, entry by entry.
std::vector<Number> combined(const Number& c, const std::vector<Number>& x, const Number& d,
                             const std::vector<Number>& y) {
  const bool from_x = !x.empty() && !is_zero(c), from_y = !y.empty() && !is_zero(d);
  std::vector<Number> sum(from_x ? x.size() : from_y ? y.size() : 0);
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (from_x && !is_zero(x[i])) sum[i] = c * x[i];
    if (from_y && !is_zero(y[i])) sum[i] = sum[i] + d * y[i];
  }
  return sum;
}

void widen(std::vector<Number>& x, std::size_t size) {
  if (x.empty()) x.resize(size);
}

/// sum_ij += c x_i y_j.
void add_product(std::vector<Number>& sum, const Number& c, const std::vector<Number>& x,
                 const std::vector<Number>& y) {
  if (is_zero(c) || x.empty() || y.empty()) return;
  widen(sum, x.size() * y.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < y.size(); ++j)
      if (!is_zero(x[i]) && !is_zero(y[j])) sum[i * y.size() + j] = sum[i * y.size() + j] + c * x[i] * y[j];
}

ExactJet chained(const NumberPartials& p, const ExactJet& a, const ExactJet& b, JetPart part) {
  ExactJet f;
  f.value = p.f;
  f.along = p.a * a.along + p.b * b.along;
  if (part == JetPart::rates) return f;
  f.along_twice = p.a * a.along_twice + p.b * b.along_twice + p.aa * a.along * a.along +
                  two * p.ab * a.along * b.along + p.bb * b.along * b.along;
  f.by_q = combined(p.a, a.by_q, p.b, b.by_q);
  // What only A and z are made of needs no names: a contact hangs on f and its derivatives by q and t.
  const NumberPartials bare{p.f,           p.a.unnamed(), p.b.unnamed(), p.aa.unnamed(), p.ab.unnamed(),
                            p.bb.unnamed()};
  f.by_v = combined(bare.a, a.by_v, bare.b, b.by_v);
  // ∂(Df)/∂v: the second derivatives with D on one side.
  const Number with_a = bare.aa * a.along.unnamed() + bare.ab * b.along.unnamed(),
               with_b = bare.ab * a.along.unnamed() + bare.bb * b.along.unnamed();
  const std::vector<Number> first = combined(bare.a, a.along_by_v, bare.b, b.along_by_v);
  f.along_by_v = combined(one, first, one, combined(with_a, a.by_v, with_b, b.by_v));
  f.by_vv = combined(bare.a, a.by_vv, bare.b, b.by_vv);
  add_product(f.by_vv, bare.aa, a.by_v, a.by_v);
  add_product(f.by_vv, bare.ab, a.by_v, b.by_v);
  add_product(f.by_vv, bare.ab, b.by_v, a.by_v);
  add_product(f.by_vv, bare.bb, b.by_v, b.by_v);
  return f;
}

}  // namespace

std::optional<Fraction> literal_value(const Tape& tape, NodeId node) {
  const std::string& text = tape.text(node);
  const std::size_t mark = text.find(radius_mark), exact = text.find(radius_mark, mark + 1);
  if (mark == std::string::npos) return convex::read_fraction(text);
  if (exact == std::string::npos) return std::nullopt;
  return convex::read_fraction(text.substr(exact + 1));
}

ExactJet ExactEvaluation::variable(NodeId node) const {
  ExactJet jet;
  const std::size_t n = state_->q.size(), i = tape_->a(node);
  switch (tape_->operation(node)) {
    case Operation::coordinate:
      jet.value = state_->q[i];
      jet.along = state_->v[i];
      if (part_ == JetPart::rates) break;
      widen(jet.by_q, n);
      jet.by_q[i] = one;
      break;
    case Operation::velocity:
      jet.value = state_->v[i];
      if (part_ == JetPart::rates) break;
      widen(jet.by_v, n);
      jet.by_v[i] = one;
      break;
    default:
      jet.value = state_->t;
      jet.along = one;
  }
  return jet;
}

/// The branch that a known sign takes; the other need not exist.
std::optional<ExactJet> ExactEvaluation::branch(NodeId node) const {
  const Operation operation = tape_->operation(node);
  const auto &a = *known_[tape_->a(node)], &b = *known_[tape_->b(node)];
  if (!a || (!is_where(operation) && !b)) return std::nullopt;
  const auto sign = is_where(operation)           ? a->value.sign()
                    : operation == Operation::max ? (a->value - b->value).sign()
                                                  : (b->value - a->value).sign();
  if (!sign) return std::nullopt;
  if (!is_where(operation)) return *sign >= 0 ? a : b;
  return (*sign < 0) == (operation == Operation::where_negative) ? b : ExactJet{};
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
    case Operation::pi: {
      if (precision_ == 0) return std::nullopt;
      ExactJet jet;
      jet.value = Number(Ball::pi(precision_), atom("pi", {1, 1}), algebraic_pi());
      return jet;
    }
    case Operation::coordinate:
    case Operation::velocity:
    case Operation::time:
      return variable(node);
    case Operation::parameter:
      return *known_[tape_->a(node)];
    case Operation::min:
    case Operation::max:
    case Operation::where_not_negative:
    case Operation::where_negative:
      return branch(node);
    default: {
      const auto& a = *known_[tape_->a(node)];
      const auto& b = arity(operation) == 2 ? *known_[tape_->b(node)] : a;
      if (!a || !b) return std::nullopt;
      const auto p =
          number_partials(operation, a->value, b->value, tape_->is_constant(tape_->b(node)), precision_);
      if (!p) return std::nullopt;
      return arity(operation) == 2 ? chained(*p, *a, *b, part_) : chained(*p, *a, ExactJet{}, part_);
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
