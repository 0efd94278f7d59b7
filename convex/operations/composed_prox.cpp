#include "convex/operations/composed_prox.hpp"

#include <algorithm>
#include <cmath>

#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

/// Which of two ways is the weaker evidence.
int rank(ProxRoute route) { return static_cast<int>(route); }
int rank(Status status) {
  switch (status) {
    case Status::solved:
      return 0;
    case Status::inaccurate:
      return 1;
    case Status::gave_up:
      return 2;
    case Status::infeasible:
      return 3;
  }
  return 3;
}

/// What the whole is told by, as one of its parts was found by `part`.
void take_weaker_evidence(Prox& whole, const Prox& part) {
  if (rank(part.status) > rank(whole.status)) whole.status = part.status;
  if (rank(part.route) > rank(whole.route)) whole.route = part.route;
  whole.by_conjugate = whole.by_conjugate || part.by_conjugate;
  if (whole.method.find(part.method) == std::string::npos)
    whole.method += (whole.method.empty() ? "" : ", ") + part.method;
}

bool is_homogeneous(const Function& f) { return f.facts().support || f.facts().cone; }

bool is_one_function_of_each_entry(const Function& f) { return f.facts().separable && f.dimension() == 0; }

bool is_multiple_of_identity(const Metric& W) {
  return is_diagonal_kind(W) && W.diagonal().minCoeff() == W.diagonal().maxCoeff();
}

/// The parts in order of application: the first before the rest, or the rest before the last.
struct Composition {
  Function first, last;
};

/// The k-th part of `parts`, and the sum of the others.
std::pair<Function, Function> taken_out(std::span<const Function> parts, std::size_t k) {
  std::vector<Function> others(parts.begin(), parts.end());
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
  return {parts[k], proper_sum(others)};
}

std::optional<Composition> composition(std::span<const Function> parts) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto all_others = [&](bool (*holds)(const Function&)) {
      for (std::size_t j = 0; j < parts.size(); ++j)
        if (j != k && !holds(parts[j])) return false;
      return true;
    };
    const Facts facts = parts[k].facts();
    if (facts.radial && all_others(is_homogeneous)) {
      auto [f, g] = taken_out(parts, k);
      return Composition{std::move(g), std::move(f)};
    }
    if (facts.by_order && all_others(is_one_function_of_each_entry)) {
      auto [g, f] = taken_out(parts, k);
      return Composition{std::move(g), std::move(f)};
    }
  }
  return std::nullopt;
}

/// f_1, …, f_n, where they are known.
std::optional<std::vector<Function>> entries_of(const FunctionNode& f, Index n) {
  std::vector<Function> entries;
  for (Index i = 0; i < n; ++i) {
    if (i > 0 && f.dimension() == 0) {
      entries.push_back(entries[0]);
    } else if (auto one = f.entry(i)) {
      entries.push_back(*std::move(one));
    } else {
      return std::nullopt;
    }
  }
  return entries;
}

}  // namespace

std::optional<Prox> composed_prox(std::span<const Function> parts, const Vector& z, const Metric& W,
                                  const Look& look) {
  if (parts.size() < 2 || !is_multiple_of_identity(W)) return std::nullopt;
  const auto order = composition(parts);
  if (!order) return std::nullopt;
  const Prox u = order->first.prox(z, W, look);
  if (u.x.size() == 0) return std::nullopt;
  const Prox x = order->last.prox(u.x, W, look);
  if (x.x.size() == 0) return std::nullopt;
  Prox made = x;
  take_weaker_evidence(made, u);
  // A prox expands nothing: the error of u is one of x.
  Prox whole = moved(made, x.x, u.v + x.v, u.error_bound + x.error_bound, z, W);
  whole.duality_gap = u.duality_gap + x.duality_gap;
  // u.v is a subgradient of the first function at x too.
  if (u.values && x.values)
    whole.values = {sum_of(order->first.evaluate(x.x), x.values->f_x), sum_of(u.values->f_v, x.values->f_v),
                    std::max(u.values->miss, x.values->miss)};
  whole.method += ", one prox after another";
  return whole;
}

std::optional<Prox> prox_by_entries(const FunctionNode& f, const Vector& z, const Metric& W,
                                    const Look& look) {
  if (z.size() < 2 || !is_diagonal_kind(W) || !f.facts().separable) return std::nullopt;
  const auto entries = entries_of(f, z.size());
  if (!entries) return std::nullopt;
  std::vector<Prox> proxes;
  for (Index i = 0; i < z.size(); ++i)
    proxes.push_back((*entries)[static_cast<std::size_t>(i)].prox(z.segment(i, 1), block(W, i, 1), look));
  Prox whole = joined(proxes);
  const auto constant = f.constant_beside_entries();
  if (constant && whole.values)
    whole = with_values(whole, whole.values, *constant, {-constant->value, constant->error});
  else
    whole.values.reset();
  whole.method += " by entries";
  return whole;
}

std::optional<Value> value_by_entries(const FunctionNode& f, const Vector& x) {
  if (x.size() < 2 || !f.facts().separable) return std::nullopt;
  std::optional<Value> total = f.constant_beside_entries();
  const auto entries = total ? entries_of(f, x.size()) : std::nullopt;
  if (!entries) return std::nullopt;
  for (Index i = 0; i < x.size(); ++i)
    total =
        sum_of(*total, value_near((*entries)[static_cast<std::size_t>(i)], x.segment(i, 1), length_of(x)));
  return total;
}

std::optional<Vector> subgradient_by_entries(const FunctionNode& f, const Vector& x) {
  if (x.size() < 2 || !f.facts().separable) return std::nullopt;
  const auto entries = entries_of(f, x.size());
  if (!entries) return std::nullopt;
  Vector v(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const auto slope = (*entries)[static_cast<std::size_t>(i)].subgradient(x.segment(i, 1));
    if (!slope) return std::nullopt;
    v[i] = (*slope)[0];
  }
  return v;
}

Prox joined(const std::vector<Prox>& blocks) {
  Index n = 0;
  for (const Prox& part : blocks) n += part.x.size();
  Prox whole;
  whole.values.emplace();
  whole.x.resize(n);
  whole.v.resize(n);
  double squares = 0;
  Index first = 0;
  bool has_x = true;
  for (const Prox& part : blocks) {
    const Index size = part.x.size();
    take_weaker_evidence(whole, part);
    has_x = has_x && size > 0;
    if (!has_x) continue;
    whole.x.segment(first, size) = part.x;
    whole.v.segment(first, size) = part.v;
    first += size;
    squares += part.error_bound * part.error_bound;
    whole.duality_gap += part.duality_gap;
    if (whole.values && part.values)
      whole.values = {sum_of(whole.values->f_x, part.values->f_x),
                      sum_of(whole.values->f_v, part.values->f_v),
                      std::max(whole.values->miss, part.values->miss)};
    else
      whole.values.reset();
  }
  whole.error_bound = std::sqrt(squares);
  if (!has_x) whole.x.resize(0);
  return whole;
}

}  // namespace convex::inline operations
