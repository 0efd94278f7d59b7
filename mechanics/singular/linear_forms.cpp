#include <algorithm>
#include <random>

#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "mechanics/singular/rounded_rows.hpp"
#include "mechanics/singular/singular_group.hpp"

namespace mechanics::inline singular_states {

using expression::Rounded;
using expression::TimeSeries;

/// The rows of the Hessian H of a constraint whose gradient vanishes, at a state where f = 0 is q in
/// q_0 + v (t - t_0) + N, N the null space of H: H is semidefinite, and f and its gradient are 0 at points
/// chosen at random there, at other times, hence on all of it for an analytic f. Across N f is then like the
/// square of a length (the Morse-Bott lemma), and vanishes nowhere else nearby. Empty elsewhere.
std::vector<AddedRow> SingularGroup::linear_forms(const Dependence& dependence) const {
  constexpr std::size_t most_columns = 60;
  const std::size_t n = columns_.size();
  const auto size = static_cast<Index>(n), main = dependence.main;
  if (!dependence.vanishes || n > most_columns) return {};
  const auto along_line = [&](const Vector& move, const Vector& direction, double later) {
    std::vector<TimeSeries> q(static_cast<std::size_t>(state_.q.size()));
    const double t = state_.t + later;
    const Rounded passed = Rounded(t) - Rounded(state_.t);
    for (std::size_t i = 0; i < n; ++i) {
      const auto k = static_cast<Index>(i);
      TimeSeries& own = q[static_cast<std::size_t>(columns_[i])];
      own.c[0] = place(k) + Rounded(state_.v[columns_[i]]) * passed + Rounded(move[k] * unit_[k]);
      own.c[1] = direction[k] * unit_[k];
    }
    return series_.along(q, TimeSeries(t), 2)[static_cast<std::size_t>(main)];
  };
  const Vector nowhere = Vector::Zero(size);
  std::vector<std::vector<Rounded>> hessian(n, std::vector<Rounded>(n));
  const auto half = [&](const Vector& direction) { return along_line(nowhere, direction, 0).c[2]; };
  for (std::size_t i = 0; i < n; ++i) {
    const Vector first = Vector::Unit(size, static_cast<Index>(i));
    const Rounded own = half(first);
    hessian[i][i] = own + own;
    for (std::size_t j = 0; j < i; ++j) {
      const Vector second = Vector::Unit(size, static_cast<Index>(j));
      hessian[i][j] = hessian[j][i] = half(first + second) - own - half(second);
    }
  }
  Matrix H(size, size);
  double off = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      if (!is_finite(hessian[i][j])) return {};
      H(static_cast<Index>(i), static_cast<Index>(j)) = hessian[i][j].value;
      off = std::max(off, hessian[i][j].radius);
    }
  const ScaledRows scaled(hessian, Vector::Ones(size));
  RowSpace space(size);
  const SplitRows split = split_rows(scaled.rows, scaled.radius, space);
  const convex::linear_algebra::SymmetricEigen eigen(H);
  const double rounding = static_cast<double>(n) * (off + 0x1p-48 * H.cwiseAbs().maxCoeff());
  const auto beyond = [&](double sign) { return (sign * eigen.values.array() > rounding).count(); };
  const Index rank = static_cast<Index>(split.kept.size());
  if (rank == 0 || std::max(beyond(1), beyond(-1)) != rank || std::min(beyond(1), beyond(-1)) > 0) return {};

  std::mt19937_64 random(1966);
  std::uniform_real_distribution<double> part(-1, 1);
  const auto vanishes = [](Rounded x) { return is_finite(x) && std::abs(x.value) <= 1024 * x.radius; };
  double largest = 1;
  for (Index i = 0; i < size; ++i) largest = std::max(largest, std::abs(place(i).value / unit_[i]));
  constexpr int points = 3;
  for (int point = 0; point < points; ++point) {
    Vector move(size);
    for (double& entry : move) entry = 0.1 * largest * part(random);
    move = space.off_span(std::move(move));
    const double later = 0.1 * std::max(1.0, std::abs(state_.t)) * part(random);
    for (Index i = 0; i < size; ++i) {
      const TimeSeries f = along_line(move, Vector::Unit(size, i), later);
      if (!vanishes(f.c[0] + Rounded(0, 0x1p-60)) || !vanishes(f.c[1] + Rounded(0, 0x1p-60))) return {};
    }
  }
  std::vector<AddedRow> found;
  for (const Index a : split.kept) {
    AddedRow& form = found.emplace_back();
    form.main = constraints_[static_cast<std::size_t>(main)];
    form.weights.emplace_back(form.main, 1);
    form.is_linear_form = true;
    form.row = Vector::Zero(state_.q.size());
    const double length = scaled.rows.row(a).cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < n; ++i) {
      const auto k = static_cast<Index>(i);
      if (!hessian[static_cast<std::size_t>(a)][i].may_be_zero())
        form.row[columns_[i]] = scaled.rows(a, k) / (length * unit_[k]);
    }
    form.row_radius = scaled.radius[a] / length;
  }
  return found;
}

}  // namespace mechanics::inline singular_states
