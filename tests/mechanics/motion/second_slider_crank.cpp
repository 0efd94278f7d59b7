#if __has_include(<boost/numeric/odeint.hpp>)
#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/numeric/odeint.hpp>

#include "mechanics/jet_system.hpp"
#include "tests/mechanics/motion/followed.hpp"

// The slider-crank with clearance of Flores, Leine and Glocker (2010), without friction, by a second way: C++
// functors that Jets differentiate, Boost.Odeint between events, and events by bisection. Nothing of the
// series is in it.

using namespace mechanics;
using namespace tests;

namespace {

struct SliderCrank {
  static constexpr int coordinates = 3, constraints = 4;
  double m = 0.038, l1 = 0.153, l2 = 0.306, a = 0.05, b = 0.025, c = 0.001, g = 9.81;

  template <class S>
  S kinetic(const std::array<S, 3>& q, const std::array<S, 3>& v, const S&) const {
    const S u = l1 * v[0], w = l2 * v[1], along = cos(q[0] - q[1]);
    const S first = 0.25 * u * u, second = u * u + u * w * along + 0.25 * w * w,
            third = u * u + 2.0 * u * w * along + w * w;
    return 0.5 * (m * (first + second + 2.0 * third) + 7.4e-5 * v[0] * v[0] + 5.9e-4 * v[1] * v[1] +
                  2.7e-6 * v[2] * v[2]);
  }
  template <class S>
  S potential(const std::array<S, 3>& q, const S&) const {
    const S y1 = l1 * sin(q[0]), y2 = l2 * sin(q[1]);
    return m * g * (0.5 * y1 + y1 + 0.5 * y2 + 2.0 * (y1 + y2));
  }
  std::array<double, 3> forces(const std::array<double, 3>&, const std::array<double, 3>&, double) const {
    return {0, 0, 0};
  }
  template <class S>
  std::array<S, 4> f(const std::array<S, 3>& q, const S&) const {
    const S y = l1 * sin(q[0]) + l2 * sin(q[1]), s = a * sin(q[2]), k = b * cos(q[2]);
    return {b + c - y + s - k, b + c - y - s - k, b + c + y - s - k, b + c + y + s - k};
  }
};

using Numbers = std::array<double, 6>;
using Rows = std::vector<Index>;

State state_of(const Numbers& x, double t) {
  const Eigen::Map<const Vector> all(x.data(), 6);
  return {t, all.head(3), all.tail(3)};
}

/// x >= 0 with w = G x + r >= 0 and x·w = 0 for up to four rows, by looking at all sets of rows that push.
Vector complementary(const convex::Matrix& G, const Vector& r) {
  const Index n = r.size();
  Vector best = Vector::Zero(n);
  double least = std::numeric_limits<double>::infinity();
  for (unsigned set = 0; set < (1U << n); ++set) {
    Rows in;
    for (Index i = 0; i < n; ++i)
      if ((set >> i & 1U) != 0) in.push_back(i);
    Vector x = Vector::Zero(n);
    if (!in.empty()) {
      const convex::Matrix part = G(in, in);
      const Vector pushed = part.ldlt().solve(-r(in));
      for (std::size_t k = 0; k < in.size(); ++k) x[in[k]] = pushed[static_cast<Index>(k)];
    }
    const Vector w = G * x + r;
    const double violated = -std::min(x.minCoeff() * G.diagonal().maxCoeff(), w.minCoeff());
    if (!x.allFinite() || violated >= least) continue;
    least = violated;
    best = x;
  }
  return best;
}

class ByOdeint {
 public:
  explicit ByOdeint(const System& system) : system_(system) {}

  double time = 0;
  Numbers x{0, 0, 0, 150, -75, 0};
  std::vector<double> impacts;
  int releases = 0;

  void follow(double until) {
    constexpr double step = 5e-5;
    while (time < until) {
      const double h = std::min(step, until - time);
      double end = h;
      for (const double part : {0.25, 0.5, 0.75, 1.0})
        if (is_left(part * h)) {
          end = part * h;
          break;
        }
      if (!is_left(end)) {
        x = after(h);
        time += h;
        continue;
      }
      double low = inside(end), high = end;
      for (int i = 0; i < 60; ++i) (is_left(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
      x = after(high);
      time += high;
      meet();
    }
  }

 private:
  /// A⁻¹z, A⁻¹Uᵀ and U A⁻¹Uᵀ of some rows.
  struct Equations {
    Vector free, s;
    convex::Matrix U, by_row, G;
  };
  Equations equations(const State& at, const Rows& rows) const {
    const Inertia inertia = system_.inertia(at);
    const Eigen::LLT<convex::Matrix> A{convex::Matrix(inertia.A)};
    const auto found = system_.contact_rows(at, rows);
    Equations of;
    of.U = convex::Matrix(found.U);
    of.s = found.s;
    of.free = A.solve(inertia.z);
    of.by_row = A.solve(of.U.transpose());
    of.G = of.U * of.by_row;
    return of;
  }
  Vector multipliers(const State& at) const {
    const Equations of = equations(at, held_);
    return of.G.ldlt().solve(of.s - of.U * of.free);
  }

  /// The state h later, with the contacts held.
  Numbers after(double h) const {
    namespace odeint = boost::numeric::odeint;
    Numbers there = x;
    if (h == 0) return there;
    const auto rate = [&](const Numbers& at, Numbers& dx, double t) {
      const State now = state_of(at, t);
      const Equations of = equations(now, held_);
      Vector q2 = of.free;
      if (!held_.empty()) q2 += of.by_row * of.G.ldlt().solve(of.s - of.U * of.free);
      for (std::size_t i = 0; i < 3; ++i) {
        dx[i] = at[3 + i];
        dx[3 + i] = q2[static_cast<Index>(i)];
      }
    };
    constexpr double tolerance = 1e-15;
    using Stepper = odeint::runge_kutta_fehlberg78<Numbers>;
    odeint::integrate_adaptive(odeint::make_controlled<Stepper>(tolerance, tolerance), rate, there, 0.0, h,
                               0.5 * h);
    return there;
  }

  bool is_held(Index a) const { return std::find(held_.begin(), held_.end(), a) != held_.end(); }

  /// Whether a free contact is through h later, or one that is held pulls.
  bool is_left(double h) const {
    const State at = state_of(after(h), 0);
    const ConstraintRates rates = system_.constraint_rates(at);
    for (Index a = 0; a < 4; ++a)
      if (!is_held(a) && rates.f[a] < -rounding) return true;
    return !held_.empty() && multipliers(at).minCoeff() < 0;
  }

  /// A time before which nothing is left: a contact that has just opened comes back no sooner.
  double inside(double end) const {
    double low = end;
    for (int i = 0; i < 60 && is_left(low); ++i) low *= 0.5;
    return is_left(low) ? 0 : low;
  }

  void meet() {
    State at = state_of(x, 0);
    ConstraintRates rates = system_.constraint_rates(at);
    Rows closed;
    for (Index a = 0; a < 4; ++a)
      if (is_held(a) || std::abs(rates.f[a]) <= together) closed.push_back(a);
    const bool was_held = !held_.empty();
    const Equations of = equations(at, closed);
    const Vector before = rates.df(closed);
    if (before.minCoeff() < -least_speed || !was_held) {
      if (before.minCoeff() < -least_speed) impacts.push_back(time);
      const double e = before.minCoeff() < -speed_of_rest ? 0.4 : 0;
      const Vector e_before = (before.array() > 0).select(0.0, e * before);
      at.v += of.by_row * complementary(of.G, before + e_before);
      rates = system_.constraint_rates(at);
    }
    Rows staying;
    for (const Index a : closed)
      if (std::abs(rates.df[a]) <= least_speed) staying.push_back(a);
    held_.clear();
    if (!staying.empty()) {
      const Equations now = equations(at, staying);
      const Vector push = complementary(now.G, now.U * now.free - now.s);
      for (std::size_t k = 0; k < staying.size(); ++k)
        if (push[static_cast<Index>(k)] > 0) held_.push_back(staying[k]);
    }
    if (was_held && held_.empty()) ++releases;
    for (std::size_t i = 0; i < 3; ++i) x[3 + i] = at.v[static_cast<Index>(i)];
  }

  /// Of f, whose summands are below 0.2; both corners of the slider strike within it.
  static constexpr double rounding = 2e-15, together = 1e-11;
  /// Impacts that are slower than this are the end of their sequence: what they would still move is its
  /// square.
  static constexpr double speed_of_rest = 1e-5, least_speed = 1e-9;

  const System& system_;
  Rows held_;
};

}  // namespace

TEST_CASE("Boost.Odeint takes the slider-crank with clearance to the same crank at t = 0.2, to ten digits") {
  const JetSystem<SliderCrank> functors(
      {}, {"p1", "p2", "p3"},
      {{"rear", false, {}}, {"front", false, {}}, {"low rear", false, {}}, {"low front", false, {}}});
  ByOdeint second(functors);
  second.follow(0.2);
  // The same as by Taylor series (releases.cpp).
  CHECK(second.x[0] == doctest::Approx(18.1768772105354).epsilon(1e-10));
  CHECK(second.releases == 6);
  const double first[] = {0.0026925027520212134, 0.005607797868070757, 0.007465635169560194,
                          0.008409252749069568, 0.00883164216054835};
  for (std::size_t k = 0; k < 5; ++k) CHECK(second.impacts[k] == doctest::Approx(first[k]).epsilon(1e-10));
}
#endif
