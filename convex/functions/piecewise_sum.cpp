#include "convex/functions/piecewise_sum.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/atom.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/pieces.hpp"
#include "convex/piecewise/scalar_prox.hpp"

namespace convex::inline named_functions {
namespace {

bool is_indicator(const PiecewiseQuadratic& f) {
  return std::all_of(f.segments().begin(), f.segments().end(), [](const Segment& line) {
    return line.run == 0 ? line.f == 0 : line.rise == 0 && line.y == 0 && line.f == 0;
  });
}

bool is_zero_or_infinite(double end) { return end == 0 || std::isinf(end); }

bool is_cone(const PiecewiseQuadratic& f) {
  const Interval ends = domain(f);
  return is_indicator(f) && is_zero_or_infinite(ends.low) && is_zero_or_infinite(ends.high);
}

bool is_smooth(const PiecewiseQuadratic& f) {
  return std::none_of(f.segments().begin(), f.segments().end(),
                      [](const Segment& line) { return line.run == 0; });
}

bool is_finite(const PiecewiseQuadratic& f) {
  const Interval ends = domain(f);
  return std::isinf(ends.low) && std::isinf(ends.high);
}

/// x, moved to the end of the domain that it misses by no more than the membership tolerance; and whether it
/// is in the domain.
struct Inside {
  double x = 0;
  Value membership;
};
Inside inside(const Interval& ends, double x, double size) {
  const double nearest = std::clamp(x, ends.low, ends.high);
  const Value membership = indicated(std::abs(nearest - x), size + std::abs(nearest));
  return {membership.value == 0 ? nearest : x, membership};
}

/// sup of v t over the t in an interval.
double support(const Interval& ends, double v) { return v == 0 ? 0 : v * (v > 0 ? ends.high : ends.low); }

class PiecewiseNode : public Atom {
 public:
  explicit PiecewiseNode(PiecewiseSum parts) : parts_(std::move(parts)) {}

  Index dimension() const override { return parts_.dimension; }
  Facts facts() const override {
    const auto all = [&](auto holds) {
      return std::all_of(parts_.pieces.begin(), parts_.pieces.end(), holds);
    };
    const bool plain = parts_.offset == 0;
    return {.indicator = plain && all(is_indicator),
            .cone = plain && all(is_cone),
            .support = plain && all([](const auto& f) { return is_indicator(convex::conjugate(f)); }),
            .separable = true,
            .piecewise_quadratic = true,
            .smooth = all(is_smooth),
            .finite = all(is_finite)};
  }
  Call call() const override { return parts_.call; }
  Function conjugate() const override {
    PiecewiseSum dual{.call = parts_.conjugate_call,
                      .conjugate_call = parts_.call,
                      .pieces = {},
                      .dimension = parts_.dimension,
                      .offset = -parts_.offset,
                      .form = parts_.conjugate_form,
                      .conjugate_form = parts_.form};
    for (const PiecewiseQuadratic& f : parts_.pieces) dual.pieces.push_back(convex::conjugate(f));
    return piecewise_sum(std::move(dual));
  }

  std::optional<Function> entry(Index i) const override {
    const PiecewiseQuadratic& f = piece(i);
    return piecewise_sum({.call = plq_call(f),
                          .conjugate_call = plq_call(convex::conjugate(f)),
                          .pieces = {f},
                          .dimension = 1});
  }
  std::optional<Value> constant_beside_entries() const override { return Value{parts_.offset, 0}; }

  double value(const Vector& x) const override { return evaluate(x).value; }
  Value evaluate(const Vector& x) const override {
    const double size = x.cwiseAbs().maxCoeff();
    double sum = parts_.offset, sizes = std::abs(parts_.offset);
    double doubt = 0;
    for (Index i = 0; i < x.size(); ++i) {
      const Inside at = inside(domain(piece(i)), x[i], size);
      const double entry = piece(i)(at.x);
      sum += entry;
      sizes += std::abs(entry);
      doubt += at.membership.error;
    }
    Value found = sum_of_terms(sum, sizes);
    found.error += doubt;
    return found;
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    const double size = x.cwiseAbs().maxCoeff();
    Vector v(x.size());
    for (Index i = 0; i < x.size(); ++i) {
      const auto slopes = subdifferential(piece(i), inside(domain(piece(i)), x[i], size).x);
      if (!slopes) return std::nullopt;
      v[i] = std::clamp(0.0, slopes->low, slopes->high);
    }
    return v;
  }

  double recession(const Vector& d) const override {
    double sum = 0;
    for (Index i = 0; i < d.size(); ++i) sum += support(slopes(piece(i)), d[i]);
    return sum;
  }
  double domain_support(const Vector& v) const override {
    double sum = 0;
    for (Index i = 0; i < v.size(); ++i) sum += support(domain(piece(i)), v[i]);
    return sum;
  }

  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    if (parts_.prox) return parts_.prox(z, d);
    Vector x(z.size());
    if (parts_.pieces.size() == 1)
      convex::prox(parts_.pieces[0], z, d, x);
    else
      for (Index i = 0; i < z.size(); ++i) x[i] = convex::prox(piece(i), z[i], d[i]);
    return x;
  }
  std::optional<Vector> prox_covector(const Vector&, const Vector& z, const Vector& d) const override {
    Vector v(z.size());
    for (Index i = 0; i < z.size(); ++i) v[i] = prox_point(piece(i), z[i], d[i]).y;
    return v;
  }
  Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    Vector slope(z.size());
    for (Index i = 0; i < z.size(); ++i) slope[i] = prox_derivative(piece(i), z[i], d[i]).low;
    return slope.asDiagonal();
  }

  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    if (parts_.form) return parts_.form(n);
    std::vector<LinearQuadratic> blocks;
    for (const PiecewiseQuadratic& f : parts_.pieces) {
      const Index size = parts_.pieces.size() == 1 ? n : 1;
      blocks.push_back(program(f, size));
    }
    LinearQuadratic sum = blocks.size() == 1 ? blocks[0] : convex::linear_quadratic::separable(blocks);
    sum.constant += parts_.offset;
    return sum;
  }

 private:
  const PiecewiseQuadratic& piece(Index i) const {
    return parts_.pieces.size() == 1 ? parts_.pieces[0] : parts_.pieces[static_cast<std::size_t>(i)];
  }
  static LinearQuadratic program(const PiecewiseQuadratic& f, Index n) {
    const Interval ends = domain(f);
    if (ends.low != ends.high) {
      const Pieces rows = convex::pieces(f);
      return convex::linear_quadratic::separable_pieces(n, rows.breaks, rows.coefficients);
    }
    LinearQuadraticBuilder point(n, 0);
    for (Index i = 0; i < n; ++i) {
      point.equation(ends.low);
      point.entry(i, 1);
      point.constant(f(ends.low));
    }
    return point.finish();
  }
  PiecewiseSum parts_;
};

}  // namespace

Function piecewise_sum(PiecewiseSum parts) {
  return Function(std::make_shared<PiecewiseNode>(std::move(parts)));
}

Call plq_call(const PiecewiseQuadratic& f) {
  const Pieces rows = pieces(f);
  return {"plq", {argument("breaks", rows.breaks), argument("coefficients", rows.coefficients)}};
}

}  // namespace convex::inline named_functions
