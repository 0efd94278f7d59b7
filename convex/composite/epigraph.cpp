#include "convex/composite/epigraph.hpp"

#include <limits>

#include "convex/composite/conjugate_atom.hpp"
#include "convex/composite/monotone_root.hpp"
#include "convex/composite/perspective.hpp"
#include "convex/gamma0/work_limit.hpp"

namespace convex::inline composite {
namespace {

/// Roots below this part of the point's size are 0: the point of the domain that is nearest.
constexpr double vanishing = 1e-24;

class EpigraphAtom final : public Atom {
 public:
  EpigraphAtom(std::shared_ptr<const Atom> f, Index n, double unit)
      : f_(std::move(f)), n_(n), unit_(std::abs(unit)), side_(unit > 0 ? 1 : -1) {}
  Index dimension() const override { return n_ + 1; }
  Index decomposed_size(Index) const override { return f_->decomposed_size(n_); }
  Facts facts() const override {
    const Facts of_f = f_->facts();
    return {.indicator = true, .cone = of_f.support || of_f.cone};
  }
  Call call() const override {
    const auto nested = [](const char* name, const Call& inner) -> Call {
      return {name, {{"", std::make_shared<const Call>(inner), std::nullopt}}, std::nullopt};
    };
    const Call epigraph = nested("indicator", nested("epigraph", f_->call()));
    if (side_ * unit_ == 1) return epigraph;
    Vector diagonal = Vector::Ones(n_ + 1);
    diagonal[n_] = side_ * unit_;
    Call reflected = nested("precompose", epigraph);
    reflected.arguments.push_back({"", Matrix(diagonal.asDiagonal()), std::nullopt});
    return reflected;
  }
  double value(const Vector& z) const override {
    if (inside(z)) return 0;
    // A step of a search too far out is no point of the set.
    if (!z.allFinite()) return std::numeric_limits<double>::infinity();
    const double miss = (z - project(z).point).norm();
    return miss <= membership_tolerance * z.norm() ? 0 : std::numeric_limits<double>::infinity();
  }
  Function conjugate() const override {
    return Function(perspective_atom(conjugate_atom(f_, n_), n_, -side_ / unit_));
  }
  std::optional<Vector> subgradient(const Vector& z) const override {
    if (value(z) > 0) return std::nullopt;
    return Vector::Zero(n_ + 1);
  }
  double recession(const Vector& d) const override {
    const bool inside = f_->recession(d.head(n_)) <= unit_ * side_ * d[n_];
    return inside ? 0 : std::numeric_limits<double>::infinity();
  }
  /// Of directions along x alone.
  double domain_support(const Vector& v) const override {
    return v[n_] == 0 ? f_->domain_support(v.head(n_)) : std::numeric_limits<double>::infinity();
  }
  EpigraphParts parts() const { return {f_, side_ * unit_}; }
  Vector prox_diagonal(const Vector& z, const Vector&) const override {
    return inside(z) ? z : project(z).point;
  }
  /// A multiple of (v, -1), v the slope of f at x by its own formula.
  std::optional<Vector> steep_covector(const Vector& x, const Vector& z, const Vector& d) const override {
    if (!f_->facts().smooth || inside(z)) return std::nullopt;
    const double mu = side_ * (x[n_] - z[n_]);
    const std::optional<Vector> v = f_->subgradient(x.head(n_));
    if (!(mu > 0) || !v || !v->allFinite()) return std::nullopt;
    Vector whole(n_ + 1);
    whole << *v / unit_, -side_;
    return d[0] * mu * whole;
  }
  Jacobian prox_jacobian(const Vector& z, const Vector&) const override {
    if (inside(z)) return Jacobian::identity(n_ + 1);
    const double mu = std::max(project(z).mu, smallest(z));
    const Vector x = z.head(n_), inverse = Vector::Constant(n_, unit_ / mu);
    const Vector v = slope_at(f_->prox_diagonal(x, inverse), x, mu);
    const Jacobian J = f_->prox_jacobian(x, inverse);
    const Vector Jv = J * v;
    const double slope = 1 + v.dot(Jv);
    return J.bordered(Jv, Eigen::Matrix2d{{-1 / slope, side_ / slope}, {side_ / slope, 1 - 1 / slope}});
  }

 private:
  struct Projection {
    Vector point;
    double mu = 0;
  };

  /// The subgradient (x - point)/mu of f/unit at point = prox x, from its formula where the difference is
  /// rounding.
  Vector slope_at(const Vector& point, const Vector& x, double mu) const {
    constexpr double digits_left = 1e-6;
    const Vector away = x - point;
    if (!(away.norm() > digits_left * x.norm()) && f_->facts().smooth)
      if (const std::optional<Vector> v = f_->subgradient(point); v && v->allFinite()) return *v / unit_;
    return away / mu;
  }

  bool inside(const Vector& z) const { return f_->value(z.head(n_)) <= unit_ * side_ * z[n_]; }
  static double smallest(const Vector& z) {
    return std::max(vanishing * z.norm(), std::numeric_limits<double>::min());
  }

  Projection project(const Vector& z) const {
    const Vector x = z.head(n_);
    const double t = side_ * z[n_], above = f_->value(x) / unit_ - t;
    const auto excess = [&](double mu) -> ValueAndSlope {
      WorkLimit::count(WorkLimit::of_entries(n_));
      const Vector inverse = Vector::Constant(n_, unit_ / std::max(mu, smallest(z)));
      const Vector point = f_->prox_diagonal(x, inverse), v = (x - point) / mu;
      const Jacobian J = f_->prox_jacobian(x, inverse);
      return {t + mu - f_->value(point) / unit_, 1 + std::max(0.0, v.dot(J * v))};
    };
    const double mu = monotone_root(excess, std::isfinite(above) ? above : z.norm() + 1, smallest(z));
    Projection found{Vector(n_ + 1), mu};
    found.point << f_->prox_diagonal(x, Vector::Constant(n_, unit_ / std::max(mu, smallest(z)))),
        side_ * (t + mu);
    return found;
  }

  std::shared_ptr<const Atom> f_;
  Index n_;
  double unit_, side_;
};

}  // namespace

std::shared_ptr<const Atom> epigraph_atom(std::shared_ptr<const Atom> f, Index n, double unit) {
  return std::make_shared<const EpigraphAtom>(std::move(f), n, unit);
}

std::optional<EpigraphParts> parts_of_epigraph(const Atom& set) {
  const auto* epigraph = dynamic_cast<const EpigraphAtom*>(&set);
  return epigraph ? std::optional(epigraph->parts()) : std::nullopt;
}

}  // namespace convex::inline composite
