#include "mechanics/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "convex/nearest_point/automatic.hpp"
#include "mechanics/gauss_problem.hpp"

namespace mechanics {
namespace {

using convex::Matrix;

/// Relative to its scale, less than this of a constraint is rounding.
constexpr double rounding_part = 1e-12;
/// A position that is further from holding has not been found.
constexpr double not_found = 1e-9;
/// Above this many free coordinates the curvature of the constraints is left out of the steps.
constexpr Index most_with_curvature = 60;
constexpr int most_steps = 200, most_restorations = 100, most_starts = 48;
constexpr double roundings_of_rows = 64;

bool is_among(const std::vector<Index>& chosen, Index a) {
  return std::find(chosen.begin(), chosen.end(), a) != chosen.end();
}

/// The metric of a matrix that is positive definite, else none.
std::optional<convex::Metric> definite(const Matrix& M) {
  if (!M.allFinite()) return std::nullopt;
  try {
    return convex::Metric::dense(M);
  } catch (const convex::InvalidInput&) {
    return std::nullopt;
  }
}

std::optional<Vector> solved(const Matrix& M, const Vector& right) {
  const auto metric = definite(M);
  if (!metric) return std::nullopt;
  return metric->solve(right);
}

/// The constraints at a position, for the free coordinates.
struct Place {
  Vector q;  ///< n
  Vector f, scale;
  Matrix U;            ///< every constraint by free coordinate
  double missing = 0;  ///< the root of the sum of squares of what is violated, by scale
};

class PositionSearch {
 public:
  PositionSearch(const LagrangianSystem& system, const State& guess, const AssemblyQuestion& question)
      : system_(system), guess_(guess) {
    const auto n = static_cast<Index>(system.coordinates().size());
    for (Index i = 0; i < n; ++i)
      if (!is_among(question.held, i)) free_.push_back(i);
    const auto m = static_cast<Index>(system.constraints().size());
    for (Index a = 0; a < m; ++a) {
      all_.push_back(a);
      is_equal_.push_back(system.constraints()[static_cast<std::size_t>(a)].two_sided ||
                          is_among(question.contacts, a));
    }
    is_left_out_.assign(all_.size(), false);
    const Matrix A = Matrix(system.inertia(guess).A);
    kinetic_metric(system.inertia(guess).A, system.coordinates());
    A_ = A(free_, free_);
    if (!free_.empty()) A_metric_ = convex::Metric::dense(A_);
  }

  const std::vector<Index>& free() const { return free_; }
  const Matrix& A() const { return A_; }
  bool is_equal(Index a) const { return is_equal_[static_cast<std::size_t>(a)]; }

  /// What is violated of constraint a.
  double violation(const Place& x, Index a) const {
    if (is_left_out_[static_cast<std::size_t>(a)]) return 0;
    return is_equal(a) ? x.f[a] : std::min(0.0, x.f[a]);
  }

  Place at(const Vector& q) const {
    const State state{guess_.t, q, Vector::Zero(q.size())};
    const ConstraintRates rates = system_.constraint_rates(state);
    Place x{q, rates.f, rates.f_scale, {}, 0};
    x.U = Matrix(system_.contact_rows(state, all_).U)(Eigen::all, free_);
    for (const Index a : all_) x.missing += square(violation(x, a) / x.scale[a]);
    x.missing = std::sqrt(x.missing);
    if (!std::isfinite(x.missing)) throw convex::InvalidInput("not finite");
    return x;
  }

  double moved(const Place& x) const {
    const Vector d = (x.q - guess_.q)(free_);
    return std::sqrt(std::max(0.0, d.dot(A_ * d)));
  }

  /// Ends where nothing improves; `multipliers` of the last quadratic program.
  Place nearest(Place x) const {
    Vector lambda = Vector::Zero(static_cast<Index>(all_.size()));
    double last = convex_infinity;
    int stalled = 0;
    for (int step = 0; step < most_steps; ++step) {
      const auto [d, next_lambda] = direction(x, lambda);
      if (d.size() == 0) {
        const double before = x.missing;
        x = restored(x, most_restorations);
        if (!(x.missing < 0.9 * before) && ++stalled > 3) return x;
        continue;
      }
      lambda = next_lambda;
      const double length = std::sqrt(std::max(0.0, d.dot(A_ * d)));
      const double size = std::sqrt(std::max(1.0, x.q(free_).dot(A_ * x.q(free_))));
      if (length <= 1e-15 * size) return x;
      Place next = moved_along(x, d, lambda);
      // Close to the end rounding alone is left: steps no longer shrink.
      const bool is_close = length <= 1e-7 * size;
      if (is_close && length >= 0.5 * last && next.missing >= 0.5 * x.missing) {
        if (++stalled > 2) return next.missing < x.missing ? next : x;
      }
      last = length;
      if (next.q == x.q) return x;
      x = std::move(next);
    }
    return x;
  }

  /// Levenberg's steps on the sum of squares of what is violated.
  Place restored(Place x, int steps) const {
    double damping = 1e-4;
    for (int k = 0; k < steps && x.missing > rounding_part * 1e-3; ++k) {
      std::vector<Index> rows;
      for (const Index a : all_)
        if (violation(x, a) != 0) rows.push_back(a);
      if (rows.empty()) return x;
      Matrix J(static_cast<Index>(rows.size()), static_cast<Index>(free_.size()));
      Vector r(J.rows());
      for (Index k2 = 0; k2 < J.rows(); ++k2) {
        const Index a = rows[static_cast<std::size_t>(k2)];
        J.row(k2) = x.U.row(a) / x.scale[a];
        r[k2] = violation(x, a) / x.scale[a];
      }
      const Matrix normal = J.transpose() * J;
      const Vector slope = J.transpose() * r;
      const double unit = std::max(1e-300, normal.diagonal().maxCoeff() / A_.diagonal().maxCoeff());
      bool better = false;
      for (int attempt = 0; attempt < 12 && !better; ++attempt) {
        const std::optional<Vector> step = solved(normal + damping * unit * A_, slope);
        if (!step) {
          damping *= 10;
          continue;
        }
        const Vector d = -*step;
        const std::optional<Place> next = tried(x, d, 1);
        if (next && next->missing < x.missing) {
          better = next->missing < (1 - 1e-10) * x.missing;
          x = *next;
          damping = std::max(1e-14, damping / 10);
          if (!better) return x;
        } else {
          damping *= 10;
        }
      }
      if (!better) return x;
    }
    return x;
  }

  void leave_out(Index a, bool out) { is_left_out_[static_cast<std::size_t>(a)] = out; }

 private:
  static constexpr double convex_infinity = std::numeric_limits<double>::infinity();
  static double square(double x) { return x * x; }

  std::optional<Place> tried(const Place& x, const Vector& d, double part) const {
    Vector q = x.q;
    q(free_) += part * d;
    try {
      return at(q);
    } catch (const convex::InvalidInput&) {
      return std::nullopt;
    }
  }

  /// Σ lambda_a ∂²f_a/∂q∂q by the second rates along directions.
  Matrix curvature(const Place& x, const Vector& lambda) const {
    std::vector<Index> rows;
    for (const Index a : all_)
      if (lambda[a] != 0) rows.push_back(a);
    const auto n = static_cast<Index>(free_.size());
    Matrix H = Matrix::Zero(n, n);
    if (rows.empty()) return H;
    const auto along = [&](const Vector& direction) {
      State state{guess_.t, x.q, Vector::Zero(x.q.size())};
      state.v(free_) = direction;
      const Vector s = system_.contact_rows(state, rows).s;
      double total = 0;
      for (std::size_t k = 0; k < rows.size(); ++k) total -= lambda[rows[k]] * s[static_cast<Index>(k)];
      return total;
    };
    const double rest = along(Vector::Zero(n));
    const auto form = [&](const Vector& v) { return (along(v) + along(-v)) / 2 - rest; };
    for (Index i = 0; i < n; ++i) H(i, i) = form(Vector::Unit(n, i));
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < i; ++j)
        H(i, j) = H(j, i) = (form(Vector::Unit(n, i) + Vector::Unit(n, j)) - H(i, i) - H(j, j)) / 2;
    return H;
  }

  struct Direction {
    Vector d;  ///< empty when the linearised constraints exclude each other
    Vector lambda;
  };

  Direction direction(const Place& x, const Vector& lambda) const {
    const auto n = static_cast<Index>(free_.size());
    convex::Metric H = A_metric_;
    if (n <= most_with_curvature && lambda.cwiseAbs().maxCoeff() > 0) {
      const Matrix whole = A_ - curvature(x, lambda);
      if (const auto metric = definite((whole + whole.transpose()) / 2);
          metric && metric->factor_condition() < 1e3 * A_metric_.factor_condition())
        H = *metric;
    }
    std::vector<Index> rows, two_sided;
    for (const Index a : all_) {
      if (is_left_out_[static_cast<std::size_t>(a)]) continue;
      if (is_equal(a)) two_sided.push_back(static_cast<Index>(rows.size()));
      rows.push_back(a);
    }
    convex::RowMatrix U = x.U(rows, Eigen::all);
    const Vector s = -x.f(rows), z = -(A_ * (x.q - guess_.q)(free_));
    convex::NearestPointProblem program{H, z, convex::ConstraintRows(std::move(U)), s, two_sided};
    program.radii = convex::rounding_radii(program, roundings_of_rows);
    for (Index k = 0; k < s.size(); ++k)
      program.radii->s[k] = std::max(program.radii->s[k], 1e-15 * x.scale[rows[static_cast<std::size_t>(k)]]);
    const convex::Solution solution = convex::automatic(program);
    if (solution.q.size() == 0 || !solution.q.allFinite()) return {};
    Vector all = Vector::Zero(static_cast<Index>(all_.size()));
    all(rows) = solution.lambda;
    return {solution.q, all};
  }

  /// The step, or a part of it that brings the constraints or the distance down.
  Place moved_along(const Place& x, const Vector& d, const Vector& lambda) const {
    const double weight = 2 * lambda.cwiseProduct(x.scale).cwiseAbs().maxCoeff() + 1e-300;
    const auto merit = [&](const Place& place) {
      double total = square(moved(place)) / 2;
      for (const Index a : all_) total += weight * std::abs(violation(place, a)) / place.scale[a];
      return total;
    };
    const double before = merit(x);
    std::optional<Place> kept;
    for (double part = 1; part > 1e-6; part /= 2) {
      std::optional<Place> next = tried(x, d, part);
      if (!next) continue;
      if (!kept) kept = next;
      if (merit(*next) <= before * (1 + 1e-12) || next->missing <= 0.5 * x.missing) return *next;
      if (part == 1) {  // the curvature of the constraints: a second step towards them (Maratos 1978)
        const Place corrected = restored(*next, 2);
        if (merit(corrected) <= before) return corrected;
      }
    }
    return kept && kept->missing <= x.missing ? *kept : x;
  }

  const LagrangianSystem& system_;
  const State& guess_;
  std::vector<Index> free_, all_;
  std::vector<bool> is_equal_, is_left_out_;
  Matrix A_;
  convex::Metric A_metric_ = convex::Metric::identity(0);
};

/// Starts around the guess, further and further away; the first is the guess itself.
class Starts {
 public:
  Starts(const State& guess, const std::vector<Index>& free) : guess_(guess), free_(free) {}

  Vector next() {
    Vector q = guess_.q;
    if (count_ > 0) {
      const double reach = 0.05 * std::pow(1.12, count_);
      for (const Index i : free_) q[i] += reach * std::max(1.0, std::abs(guess_.q[i])) * even_(random_);
    }
    ++count_;
    return q;
  }

 private:
  const State& guess_;
  const std::vector<Index>& free_;
  int count_ = 0;
  std::mt19937_64 random_{1};
  std::uniform_real_distribution<double> even_{-1, 1};
};

/// A place where all holds; else the one nearest to that.
Place feasible(const PositionSearch& search, const State& guess, int starts) {
  std::optional<Place> best;
  Starts from(guess, search.free());
  for (int k = 0; k < starts; ++k) {
    try {
      const Place start = search.at(from.next());
      Place found = k == 0 ? search.nearest(start) : search.restored(start, most_restorations);
      if (k > 0 && found.missing <= not_found) found = search.nearest(found);
      if (!best || found.missing < best->missing) best = std::move(found);
      if (best->missing <= rounding_part) return *best;
    } catch (const convex::InvalidInput&) {
      if (k == 0 && starts == 1) throw;
    }
  }
  if (!best) {
    search.at(guess.q);  // says what is not finite
    throw convex::InvalidInput("the constraints are not finite anywhere near the state; start elsewhere");
  }
  return *best;
}

/// Those violated constraints of which none can be left out.
std::vector<Index> fighters(PositionSearch& search, const State& guess, const Place& best) {
  std::vector<Index> found;
  double worst = 0;
  for (Index a = 0; a < best.f.size(); ++a)
    worst = std::max(worst, std::abs(search.violation(best, a)) / best.scale[a]);
  for (Index a = 0; a < best.f.size(); ++a) {
    const bool is_violated = std::abs(search.violation(best, a)) / best.scale[a] > 1e-6 * worst;
    search.leave_out(a, !is_violated);
    if (is_violated) found.push_back(a);
  }
  constexpr std::size_t most_tried = 12;
  if (found.size() > most_tried) return found;
  for (std::size_t k = 0; k < found.size() && found.size() > 1;) {
    search.leave_out(found[k], true);
    if (feasible(search, guess, most_starts / 4).missing > not_found) {
      found.erase(found.begin() + static_cast<std::ptrdiff_t>(k));
    } else {
      search.leave_out(found[k], false);
      ++k;
    }
  }
  return found;
}

/// The nearest velocity; returns the constraints that exclude each other, if any.
std::vector<Index> set_velocity(const LagrangianSystem& system, const PositionSearch& search, State& state) {
  std::vector<Index> rows, two_sided;
  const ConstraintRates rates = system.constraint_rates(state);
  for (Index a = 0; a < rates.f.size(); ++a) {
    if (!search.is_equal(a) && rates.f[a] > not_found * rates.f_scale[a]) continue;
    if (search.is_equal(a)) two_sided.push_back(static_cast<Index>(rows.size()));
    rows.push_back(a);
  }
  if (rows.empty()) return {};
  const Matrix U = Matrix(system.contact_rows(state, rows).U)(Eigen::all, search.free());
  const auto n = static_cast<Index>(search.free().size());
  const Vector v0 = state.v(search.free());
  Vector change = Vector::Zero(n);
  for (int pass = 0; pass < 3; ++pass) {
    const ConstraintRates now = system.constraint_rates(state);
    // From v0 + change on: the nearest to v0 with u·(v - v_now) >= -df_now.
    Vector s(U.rows());
    for (Index k = 0; k < s.size(); ++k) {
      const double df = now.df[rows[static_cast<std::size_t>(k)]];
      s[k] = U.row(k).dot(change) - df;
    }
    convex::NearestPointProblem problem{convex::Metric::dense(search.A()), Vector::Zero(n),
                                        convex::ConstraintRows(convex::RowMatrix(U)), s, two_sided};
    problem.radii = convex::rounding_radii(problem, roundings_of_rows);
    const convex::Solution solution = convex::automatic(problem);
    if (solution.q.size() == 0) {
      std::vector<Index> excluding;
      for (Index k = 0; k < solution.farkas.size(); ++k)
        if (solution.farkas[k] != 0) excluding.push_back(rows[static_cast<std::size_t>(k)]);
      return excluding;
    }
    change = solution.q;
    state.v(search.free()) = v0 + change;
  }
  return {};
}

double residual_of(const LagrangianSystem& system, const PositionSearch& search, const State& state) {
  const ConstraintRates rates = system.constraint_rates(state);
  double worst = 0;
  for (Index a = 0; a < rates.f.size(); ++a) {
    const double f = rates.f[a] / rates.f_scale[a], df = rates.df[a] / rates.df_scale[a];
    if (search.is_equal(a))
      worst = std::max({worst, std::abs(f), std::abs(df)});
    else
      worst = std::max({worst, -f, f <= not_found ? -df : 0.0});
  }
  return worst;
}

}  // namespace

Assembly assemble(const LagrangianSystem& system, const State& guess, const AssemblyQuestion& question) {
  PositionSearch search(system, guess, question);
  Assembly found;
  found.state = guess;
  if (search.free().empty() || guess.q.size() == 0) {
    const Place here = search.at(guess.q);
    found.status = here.missing <= not_found ? AssemblyStatus::solved : AssemblyStatus::infeasible;
    for (Index a = 0; a < here.f.size(); ++a)
      if (std::abs(search.violation(here, a)) > not_found * here.scale[a]) found.fighting.push_back(a);
    found.residual = residual_of(system, search, found.state);
    return found;
  }
  const Place best = feasible(search, guess, most_starts);
  found.state.q = best.q;
  found.moved = search.moved(best);
  if (best.missing > not_found) {
    found.status = AssemblyStatus::infeasible;
    found.residual = best.missing;
    found.fighting = fighters(search, guess, best);
    return found;
  }
  found.fighting = set_velocity(system, search, found.state);
  found.residual = residual_of(system, search, found.state);
  found.status = !found.fighting.empty()       ? AssemblyStatus::infeasible
                 : found.residual <= not_found ? AssemblyStatus::solved
                                               : AssemblyStatus::gave_up;
  return found;
}

}  // namespace mechanics
