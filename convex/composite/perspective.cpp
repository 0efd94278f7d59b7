#include "convex/composite/perspective.hpp"

#include <algorithm>

#include "convex/composite/conjugate_atom.hpp"
#include "convex/composite/epigraph.hpp"
#include "convex/composite/monotone_root.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"

namespace convex::inline composite {
namespace {

constexpr double vanishing_root = 1e-24;  ///< a root of this part of the point's size is 0
/// Nor is one below this, over which numbers of the data would be beyond doubles.
constexpr double least_root = 0x1p-900;
/// Difference quotients at these parts of |x| that agree to `agreeing` have come to their limit.
constexpr double coarse = 1e-9, fine = 1e-12, agreeing = 1e-6;

class PerspectiveAtom final : public Atom {
 public:
  PerspectiveAtom(std::shared_ptr<const Atom> f, Index n, double side)
      : f_(std::move(f)), n_(n), side_(side) {}
  Index dimension() const override { return n_ + 1; }
  Index decomposed_size(Index) const override { return f_->decomposed_size(n_); }
  Facts facts() const override { return {.cone = f_->facts().cone, .support = true}; }
  Call call() const override {
    const auto nested = [](const char* name, const Call& inner) -> Call {
      return {name, {{"", std::make_shared<const Call>(inner), std::nullopt}}, std::nullopt};
    };
    const Call perspective = nested("perspective", f_->call());
    if (side_ == 1) return perspective;
    Vector diagonal = Vector::Ones(n_ + 1);
    diagonal[n_] = side_;
    Call reflected = nested("precompose", perspective);
    reflected.arguments.push_back({"", Matrix(diagonal.asDiagonal()), std::nullopt});
    return reflected;
  }
  double value(const Vector& z) const override {
    const Vector x = z.head(n_);
    const double s = side_ * z[n_];
    if (s > 0) return s * f_->value(x / s);
    if (s < -membership_tolerance * z.norm()) return infinity;
    const double length = x.norm();
    if (length <= 0) return 0;
    const auto quotient = [&](double part) { return part * length * f_->value(x / (part * length)); };
    // The quotients rise to the limit, but for a part of f(0), and the other is an upper bound of it.
    const double limit = quotient(fine), before = quotient(coarse), bound = f_->recession(x);
    const double moved = std::abs(limit - before);
    const bool settled = moved <= agreeing * (std::abs(limit) + length * agreeing);
    return !settled || std::abs(bound - limit) <= moved ? bound : std::min(limit, bound);
  }
  Function conjugate() const override {
    return Function(epigraph_atom(conjugate_atom(f_, n_), n_, -1 / side_));
  }
  std::optional<Vector> subgradient(const Vector& z) const override {
    const double s = side_ * z[n_];
    if (!(s > 0)) return std::nullopt;
    const Vector x = z.head(n_) / s;
    const std::optional<Vector> v = f_->subgradient(x);
    if (!v) return std::nullopt;
    Vector whole(n_ + 1);
    whole << *v, side_ * (f_->value(x) - v->dot(x));
    return whole;
  }
  /// The domain is made of the rays through (x, 1), x in the domain of f.
  double domain_support(const Vector& v) const override {
    return f_->domain_support(v.head(n_)) + side_ * v[n_] <= 0 ? 0 : infinity;
  }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override {
    const double mu = root(z, d[0]);
    if (mu <= 0) return Vector::Zero(n_ + 1);
    const Vector q = d[0] * z.head(n_);
    Vector point(n_ + 1);
    point << mu / d[0] * at(q, mu), mu / d[0] / side_;
    return point;
  }
  /// (v, f(p) - p·v) at p = x/s, v the slope of f there: its product with (x, s) is the value, however much
  /// larger one of the two is than the other.
  std::optional<Vector> steep_covector(const Vector& x, const Vector& z, const Vector& d) const override {
    const double s = side_ * x[n_];
    if (!(s > 0)) return std::nullopt;
    const Vector p = x.head(n_) / s;
    const double mu = d[0] * s;
    std::optional<Vector> v = f_->steep_covector(p, d[0] * z.head(n_) / mu, Vector::Constant(n_, mu));
    if (!v && f_->facts().smooth) v = f_->subgradient(p);
    if (!v || !v->allFinite()) return std::nullopt;
    Vector whole(n_ + 1);
    whole << *v, side_ * (f_->value(p) - p.dot(*v));
    return whole;
  }
  Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    const double mu = root(z, d[0]);
    if (mu <= 0) return Jacobian(Vector(Vector::Zero(n_ + 1)));
    const Vector q = d[0] * z.head(n_), p = at(q, mu);
    const Jacobian J = f_->prox_jacobian(q / mu, Vector::Constant(n_, mu));
    if (mu <= smallest(d[0] * z.norm()))  // the point stays on the wall s = 0
      return J.bordered(Vector::Zero(n_), Eigen::Matrix2d::Zero());
    const Vector moved = p - J * p;
    const double square = side_ * side_, slope = 1 + square * std::max(0.0, p.dot(moved));
    return J.bordered(moved, Eigen::Matrix2d{{square / slope, side_ / slope}, {side_ / slope, 1 / slope}});
  }

 private:
  Vector at(const Vector& q, double mu) const { return f_->prox_diagonal(q / mu, Vector::Constant(n_, mu)); }

  static double smallest(double size) { return std::max(vanishing_root * size, least_root); }

  /// The root mu; 0 where the prox is 0.
  double root(const Vector& z, double d) const {
    const Vector q = d * z.head(n_);
    const double s = d * side_ * z[n_];
    const double square = side_ * side_;
    if (square * f_->conjugate().node().value(q) <= -s) return 0;
    const double size = d * z.norm(), least = smallest(size);
    const auto excess = [&](double at_mu) -> ValueAndSlope {
      WorkLimit::count(WorkLimit::of_entries(n_));
      const double mu = std::max(at_mu, least);
      const Vector p = at(q, mu), step = Vector::Constant(n_, mu);
      const Jacobian J = f_->prox_jacobian(q / mu, step);
      // Far out on a flat part the difference q - mu p is all rounding, where a formula, or a gradient, is
      // not.
      const double moved = std::max(0.0, p.dot(p - J * p));
      std::optional<Vector> v = f_->prox_covector(p, q / mu, step);
      if (!v && f_->facts().smooth && moved < 0.5 * p.squaredNorm()) v = f_->subgradient(p);
      if (!v || !v->allFinite()) v = q - mu * p;
      return {square * (f_->value(p) - p.dot(*v)) + mu - s, 1 + square * moved};
    };
    return std::max(monotone_root(excess, s > 0 ? s : size > 0 ? size : 1, least), least);
  }

  std::shared_ptr<const Atom> f_;
  Index n_;
  double side_;
};

}  // namespace

std::shared_ptr<const Atom> perspective_atom(std::shared_ptr<const Atom> f, Index n, double side) {
  return std::make_shared<const PerspectiveAtom>(std::move(f), n, side);
}

}  // namespace convex::inline composite
