#pragma once

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "mechanics/system.hpp"

/// Systems whose T, V, Q and f are C++ functions, written once for any scalar type S and differentiated by
/// ceres::Jet. This header stands alone: nothing else includes it.
namespace mechanics {

/// A number type J of automatic differentiation, ceres::Jet<double, N> or ceres::Jet<ceres::Jet<double, M>,
/// N>, as a scalar that plain code can use: 0.5*x, x + 1, S(0.0), pow(x, 2), which nested Jets alone do not
/// compile.
template <class J>
class Lifted {
 public:
  Lifted(double x = 0) : jet(constant<J>(x)) {}  // implicit, so that a number may stand wherever a Lifted may
  explicit Lifted(J j) : jet(std::move(j)) {}

  J jet;

  friend Lifted operator+(const Lifted& x) { return x; }
  friend Lifted operator-(const Lifted& x) { return Lifted(-x.jet); }
  friend Lifted operator+(const Lifted& x, const Lifted& y) { return Lifted(x.jet + y.jet); }
  friend Lifted operator-(const Lifted& x, const Lifted& y) { return Lifted(x.jet - y.jet); }
  friend Lifted operator*(const Lifted& x, const Lifted& y) { return Lifted(x.jet * y.jet); }
  friend Lifted operator/(const Lifted& x, const Lifted& y) { return Lifted(x.jet / y.jet); }
  Lifted& operator+=(const Lifted& y) { return *this = *this + y; }
  Lifted& operator-=(const Lifted& y) { return *this = *this - y; }
  Lifted& operator*=(const Lifted& y) { return *this = *this * y; }
  Lifted& operator/=(const Lifted& y) { return *this = *this / y; }
  friend bool operator<(const Lifted& x, const Lifted& y) { return x.jet < y.jet; }
  friend bool operator>(const Lifted& x, const Lifted& y) { return x.jet > y.jet; }
  friend bool operator<=(const Lifted& x, const Lifted& y) { return x.jet <= y.jet; }
  friend bool operator>=(const Lifted& x, const Lifted& y) { return x.jet >= y.jet; }
  friend Lifted sin(const Lifted& x) { return Lifted(ceres::sin(x.jet)); }
  friend Lifted cos(const Lifted& x) { return Lifted(ceres::cos(x.jet)); }
  friend Lifted tan(const Lifted& x) { return Lifted(ceres::tan(x.jet)); }
  friend Lifted asin(const Lifted& x) { return Lifted(ceres::asin(x.jet)); }
  friend Lifted acos(const Lifted& x) { return Lifted(ceres::acos(x.jet)); }
  friend Lifted atan(const Lifted& x) { return Lifted(ceres::atan(x.jet)); }
  friend Lifted atan2(const Lifted& y, const Lifted& x) {
    return Lifted(ceres::atan2(y.jet + 0.0, x.jet + 0.0));
  }
  friend Lifted sinh(const Lifted& x) { return Lifted(ceres::sinh(x.jet)); }
  friend Lifted cosh(const Lifted& x) { return Lifted(ceres::cosh(x.jet)); }
  friend Lifted tanh(const Lifted& x) { return Lifted(ceres::tanh(x.jet)); }
  friend Lifted exp(const Lifted& x) { return Lifted(ceres::exp(x.jet)); }
  friend Lifted log(const Lifted& x) { return Lifted(ceres::log(x.jet)); }
  friend Lifted sqrt(const Lifted& x) { return Lifted(ceres::sqrt(x.jet)); }
  friend Lifted abs(const Lifted& x) { return Lifted(ceres::abs(x.jet)); }
  friend Lifted pow(const Lifted& x, double p) { return Lifted(power(x.jet, p)); }
  friend Lifted pow(const Lifted& x, const Lifted& y) { return exp(y * log(x)); }

 private:
  template <class K>
  static K constant(double x) {
    if constexpr (std::is_same_v<K, double>)
      return x;
    else
      return K(constant<typename K::Scalar>(x));
  }
  /// x^p with the derivative p x^(p-1), also where x = 0 and p is 0, 1 or 2.
  template <class K>
  static K power(const K& x, double p) {
    if constexpr (std::is_same_v<K, double>) {
      return std::pow(x, p);
    } else {
      using Inner = typename K::Scalar;
      if (p == 0) return constant<K>(1);
      if (p == 1) return x;
      return K(power(x.a, p), (constant<Inner>(p) * power(x.a, p - 1)) * x.v);
    }
  }
};

/// A mechanical system from a `Model`:
///
///     struct Model {
///       static constexpr int coordinates = 2, constraints = 1;
///       template <class S> S kinetic(const std::array<S, 2>& q, const std::array<S, 2>& v, const S& t)
///       const; template <class S> S potential(const std::array<S, 2>& q, const S& t) const; // optional
///       std::array<double, 2> forces(const std::array<double, 2>& q, const std::array<double, 2>& v, double
///       t) const; template <class S> std::array<S, 1> f(const std::array<S, 2>& q, const S& t) const;  // if
///       constraints > 0
///     };
///
/// `forces` is optional. T must be quadratic in v; this is not checked. A is dense.
/// The summands of f are not known here: f_scale_a is the largest of |u_i q_i| and of what these leave of
/// f_a.
template <class Model>
class JetSystem : public System {
 public:
  /// One name per coordinate, one Constraint per component of f.
  JetSystem(Model model, std::vector<std::string> coordinates, std::vector<Constraint> constraints)
      : model_(std::move(model)), coordinates_(std::move(coordinates)), constraints_(std::move(constraints)) {
    if (coordinates_.size() != n || constraints_.size() != m)
      throw convex::InvalidInput("JetSystem: the model has " + std::to_string(n) + " coordinates and " +
                                 std::to_string(m) + " constraints; give as many names");
  }

  const std::vector<std::string>& coordinates() const override { return coordinates_; }
  const std::vector<Constraint>& constraints() const override { return constraints_; }

  Inertia inertia(const State& state) const override {
    // Outer: v. Inner: v, and the direction q' = v, t' = 1. So T_v and its derivatives by v and along the
    // motion.
    using Inner = ceres::Jet<double, nn + 1>;
    using Second = Lifted<ceres::Jet<Inner, nn>>;
    std::array<Second, n> q, v;
    for (int i = 0; i < nn; ++i) {
      q[at(i)].jet.a = along<nn + 1>(state.q[i], nn, state.v[i]);
      v[at(i)].jet.a = Inner(state.v[i], i);
      v[at(i)].jet.v[i] = Inner(1.0);
    }
    Second t;
    t.jet.a = along<nn + 1>(state.t, nn, 1);
    const Second T = model_.kinetic(q, v, t);
    Eigen::MatrixXd A(nn, nn);
    Inertia result{{}, Vector(nn)};
    for (int i = 0; i < nn; ++i) {
      for (int j = 0; j <= i; ++j) A(i, j) = A(j, i) = T.jet.v[i].v[j];
      result.z[i] = -T.jet.v[i].v[nn];
    }
    using First = Lifted<ceres::Jet<double, nn>>;
    std::array<First, n> q1, v1;
    for (int i = 0; i < nn; ++i) {
      q1[at(i)] = First(ceres::Jet<double, nn>(state.q[i], i));
      v1[at(i)] = First(state.v[i]);
    }
    result.z += model_.kinetic(q1, v1, First(state.t)).jet.v;
    if constexpr (requires { model_.potential(q1, First()); })
      result.z -= model_.potential(q1, First(state.t)).jet.v;
    if constexpr (requires { model_.forces(plain(state.q), plain(state.v), 0.0); }) {
      const auto Q = model_.forces(plain(state.q), plain(state.v), state.t);
      for (int i = 0; i < nn; ++i) result.z[i] += Q[at(i)];
    }
    if (!A.allFinite() || !result.z.allFinite()) refuse("kinetic, potential or forces");
    result.A = A.sparseView(0, 0);
    return result;
  }

  ConstraintRates constraint_rates(const State& state) const override {
    const auto f = gradients(state);
    ConstraintRates result{Vector(mm), Vector(mm), Vector(mm), Vector(mm)};
    for (int a = 0; a < mm; ++a) {
      const auto& [value, u] =
          std::pair<double, Eigen::Matrix<double, nn + 1, 1>>(f[at(a)].jet.a, f[at(a)].jet.v);
      const Vector moved = u.template head<nn>().cwiseProduct(state.v),
                   placed = u.template head<nn>().cwiseProduct(state.q);
      result.f[a] = value;
      result.df[a] = moved.sum() + u[nn];
      result.f_scale[a] = std::max({1.0, placed.cwiseAbs().maxCoeff(), std::abs(value - placed.sum())});
      result.df_scale[a] = std::max({1.0, moved.cwiseAbs().maxCoeff(), std::abs(u[nn])});
      if (!std::isfinite(value) || !u.allFinite()) refuse("constraint " + constraints_[at(a)].name);
    }
    return result;
  }

  ContactRows contact_rows(const State& state, const std::vector<Index>& constraints) const override {
    const auto f = gradients(state);
    const Vector ddf = second_rates(state, Vector::Zero(nn));
    const auto rows = static_cast<Index>(constraints.size());
    Eigen::MatrixXd U(rows, nn);
    ContactRows result{{}, Vector(rows)};
    for (Index k = 0; k < rows; ++k) {
      const Index a = constraints[static_cast<std::size_t>(k)];
      U.row(k) = f[static_cast<std::size_t>(a)].jet.v.template head<nn>();
      result.s[k] = 0.0 - ddf[a];
    }
    result.U = U.sparseView(0, 0);
    return result;
  }

  Vector second_rates(const State& state, const Vector& q2) const override {
    using Inner = ceres::Jet<double, 1>;  // outer and inner: along the motion
    using Second = Lifted<ceres::Jet<Inner, 1>>;
    std::array<Second, n> q;
    for (int i = 0; i < nn; ++i) {
      q[at(i)].jet.a = along<1>(state.q[i], 0, state.v[i]);
      q[at(i)].jet.v[0] = along<1>(state.v[i], 0, q2[i]);
    }
    Second t;
    t.jet.a = along<1>(state.t, 0, 1);
    t.jet.v[0] = Inner(1.0);
    Vector result(mm);
    if constexpr (mm > 0) {
      const auto f = model_.f(q, t);
      for (int a = 0; a < mm; ++a) {
        result[a] = f[at(a)].jet.v[0].v[0];
        if (!std::isfinite(result[a])) refuse("constraint " + constraints_[at(a)].name);
      }
    }
    return result;
  }

  double energy(const State& state) const override {
    double energy = model_.kinetic(plain(state.q), plain(state.v), state.t);
    if constexpr (requires { model_.potential(plain(state.q), 0.0); })
      energy += model_.potential(plain(state.q), state.t);
    if (!std::isfinite(energy)) refuse("kinetic or potential");
    return energy;
  }

 private:
  static constexpr int nn = Model::coordinates, mm = Model::constraints;
  static constexpr std::size_t n = nn, m = mm;
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  template <int N>
  static ceres::Jet<double, N> along(double value, int direction, double rate) {
    ceres::Jet<double, N> jet(value);
    jet.v[direction] = rate;
    return jet;
  }

  static std::array<double, n> plain(const Vector& x) {
    std::array<double, n> result;
    std::copy(x.begin(), x.end(), result.begin());
    return result;
  }

  /// f with its derivatives by q and, last, by t.
  auto gradients(const State& state) const {
    using First = Lifted<ceres::Jet<double, nn + 1>>;
    std::array<First, n> q;
    for (int i = 0; i < nn; ++i) q[at(i)] = First(ceres::Jet<double, nn + 1>(state.q[i], i));
    const First t(ceres::Jet<double, nn + 1>(state.t, nn));
    if constexpr (mm > 0)
      return std::array<First, m>(model_.f(q, t));
    else
      return std::array<First, m>{};
  }

  [[noreturn]] static void refuse(const std::string& what) {
    throw convex::InvalidInput(what +
                               ": a value or a derivative is not finite at this state; start where it is");
  }

  Model model_;
  std::vector<std::string> coordinates_;
  std::vector<Constraint> constraints_;
};

}  // namespace mechanics
