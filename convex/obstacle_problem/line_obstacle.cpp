#include "convex/obstacle_problem/line_obstacle.hpp"

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/obstacle_problem/line_quadrature.hpp"

namespace convex::inline obstacle_problem {
namespace {

constexpr Index first_cells = 64;
/// Cells are halved down to this part of the line; edges of p > 0 are known as well.
constexpr double shortest_part = 0x1p-44;
/// What a sum of terms of this absolute size may be off.
constexpr double rounding = 16 * unit_roundoff;
constexpr int most_rounds = 400, most_active_sets = 1000;

using Kind = LineEnd::Kind;

/// The cells, the loads in them, and the active set.
class LineCells {
 public:
  LineCells(const LineObstacle& problem, bool one_sided)
      : problem_(problem), w_{problem.power}, one_sided_(one_sided) {
    shortest_ = (problem.high - problem.low) * shortest_part;
    r.push_back(problem.low);
    double absolute = 0;
    std::vector<CellLoad> coarse;
    const auto end = [&](Index k) {
      return problem.low + (problem.high - problem.low) * static_cast<double>(k) / first_cells;
    };
    for (Index k = 0; k < first_cells; ++k) {
      coarse.push_back(cell_load(problem.h, w_, end(k), end(k + 1)));
      absolute += coarse.back().absolute_moment;
    }
    resolved_ = 0x1p-50 * absolute / first_cells;
    for (const LineEnd& side : {problem.at_low, problem.at_high})
      ends_ += std::abs(side.value) * (side.kind == Kind::flux ? problem.high - problem.low : 1);
    has_departures_ = problem.departure && hidden(problem.low, problem.high) > seen();
    for (Index k = 0; k < first_cells; ++k) add(end(k), end(k + 1), coarse[static_cast<std::size_t>(k)]);
    zero.assign(r.size(), false);
    flux.assign(r.size(), 0);
    p.assign(r.size(), 0);
  }

  std::vector<double> r, p, flux;
  std::vector<CellLoad> cells;
  std::vector<bool> zero;  // p = 0 by the obstacle

  std::size_t first() const { return problem_.at_low.kind == Kind::centre ? 1 : 0; }
  std::size_t last() const { return r.size() - 1; }
  double w(std::size_t node) const { return w_(r[node]); }
  double resistance(std::size_t cell) const { return cells[cell].resistance; }
  double end_flux(const LineEnd& end, std::size_t node) const { return end.value * w(node); }

  /// The sum of the loads, for lines without a given value, and its rounding.
  std::pair<double, double> surplus() const {
    double sum = 0, absolute = 0;
    for (const CellLoad& cell : cells) {
      sum += cell.load;
      absolute += cell.absolute;
    }
    for (const auto& [end, node] : {std::pair{problem_.at_low, std::size_t{0}}, {problem_.at_high, last()}})
      if (end.kind == Kind::flux) {
        sum += end_flux(end, node);
        absolute += std::abs(end_flux(end, node));
      }
    return {sum, rounding * absolute};
  }

  /// p between the nodes where it is known: it is known at both, or the flux is at one.
  void solve_run(std::size_t from, std::size_t to) {
    const bool known_low = is_known(from), known_high = is_known(to);
    double resistance_sum = 0, fall = 0, load = 0, absolute = 0;  // of p from `from` with flux 0
    for (std::size_t k = from; k < to; ++k) {
      const double R = resistance(k);
      fall += load * R + cells[k].moment;
      absolute += std::abs(load) * R + cells[k].absolute_moment;
      load += cells[k].load;
      resistance_sum += R;
    }
    const double left = known_low ? known_value(from) : 0, right = known_high ? known_value(to) : 0;
    double K = 0, start = left;
    if (known_low && known_high) {
      K = (right - left + fall) / resistance_sum;
    } else if (known_high) {
      K = low_flux(from);
      start = right - K * resistance_sum + fall;
    } else if (known_low) {
      K = end_flux(problem_.at_high, to) + load;
    } else {
      K = low_flux(from);
    }
    rounding_ = std::max(
        rounding_, rounding * (std::abs(left) + std::abs(right) + absolute + std::abs(K) * resistance_sum));
    p[from] = start;
    for (std::size_t k = from; k < to; ++k) {
      flux[k] = K;
      slack_[k] = rounding * ((std::abs(left) + std::abs(right) + absolute) / resistance_sum + std::abs(K));
      p[k + 1] = p[k] + K * resistance(k) - cells[k].moment;
      K -= cells[k].load;
    }
    if (!known_high) return;
    p[to] = right;  // near this end p is summed from it, so that it is exact where it is small
    for (std::size_t k = to; k-- > (from + to) / 2 + 1;)
      p[k] = p[k + 1] - flux[k] * resistance(k) + cells[k].moment;
  }

  /// p with the present active set.
  void solve() {
    rounding_ = 0;
    slack_.assign(r.size(), 0);
    std::size_t from = first();
    for (std::size_t to = from + 1; to <= last(); ++to)
      if (to == last() || is_known(to)) {
        solve_run(from, to);
        from = to;
      }
  }

  /// Primal-dual active sets; ends after finitely many steps, for the equations have an M-matrix.
  void solve_obstacle() {
    for (int step = 0; step < most_active_sets; ++step) {
      solve();
      if (!one_sided_) return;
      bool changed = false;
      for (std::size_t k = first(); k <= last(); ++k) {
        if (is_value_end(k)) continue;
        const bool was = zero[k];
        if (was ? push(k) < -push_slack(k) : p[k] < 0) {
          zero[k] = !was;
          changed = true;
        }
      }
      if (!changed) return;
    }
  }

  /// What the obstacle adds at a node.
  double push(std::size_t k) const { return flux_below(k) - flux_above(k); }
  double push_slack(std::size_t k) const {
    return (k > 0 ? slack_[k - 1] : 0) + slack_[k] +
           rounding * (std::abs(flux_below(k)) + std::abs(flux_above(k)));
  }

  /// Halves the cells where p turns from 0, is below 0 between nodes, or is 0 although h > 0. False when none
  /// is left that could be halved.
  bool refine() {
    std::vector<bool> halve(cells.size(), false);
    const auto mark = [&](std::size_t cell) {
      if (r[cell + 1] - r[cell] > shortest_) halve[cell] = true;
    };
    for (std::size_t k = first(); k < cells.size(); ++k) {
      const bool low = is_zero(k), high = is_zero(k + 1);
      if (low != high) {
        mark(k);
        const std::size_t node = low ? k : k + 1;
        if (low && node > 0) mark(node - 1);
        if (high && node < cells.size()) mark(node);
      } else if (low) {
        // p is 0 in no place where h > 0, whatever the loads beside it push; of a p within rounding nothing
        // is known.
        if (cells[k].largest_source * (r[k + 1] - r[k]) * cells[k].resistance > rounding_) mark(k);
      } else if (std::min(p[k], p[k + 1]) < largest_dip(k)) {
        for (double x : gauss_legendre().point)
          if (value(k, r[k] + (r[k + 1] - r[k]) * (0.5 + 0.5 * x)) < -rounding_) mark(k);
      }
    }
    // A wall that sucks, ∂p/∂n >= value > 0, has p > 0.
    const auto draws = [&](const LineEnd& end, std::size_t node, std::size_t cell) {
      return end.kind == Kind::flux && is_zero(node) &&
             end_flux(end, node) * cells[cell].resistance > rounding_;
    };
    if (draws(problem_.at_low, 0, 0)) mark(0);
    if (draws(problem_.at_high, last(), last() - 1)) mark(last() - 1);
    if (first() == 1 && !is_zero(1) && value(0, 0) < -rounding_) mark(0);
    if (has_many()) return false;
    if (std::none_of(halve.begin(), halve.end(), [](bool b) { return b; })) return false;
    std::vector<double> old_r;
    std::vector<CellLoad> old_cells;
    std::vector<bool> old_zero;
    old_r.swap(r);
    old_cells.swap(cells);
    old_zero.swap(zero);
    r.push_back(old_r.front());
    zero.push_back(old_zero.front());
    for (std::size_t k = 0; k < old_cells.size(); ++k) {
      if (halve[k]) {
        const double middle = 0.5 * (old_r[k] + old_r[k + 1]);
        put(old_r[k], middle);
        put(middle, old_r[k + 1]);
        zero.push_back(old_zero[k] && old_zero[k + 1]);
      } else {
        cells.push_back(old_cells[k]);
        r.push_back(old_r[k + 1]);
      }
      zero.push_back(old_zero[k + 1]);
    }
    p.assign(r.size(), 0);
    flux.assign(r.size(), 0);
    return true;
  }

  /// p in a cell, which may be that of the centre.
  double value(std::size_t cell, double at) const {
    return LineSolution::between(problem_, r, p, flux, cell, at);
  }
  bool is_zero(std::size_t k) const { return zero[k] || (is_value_end(k) && !(known_value(k) > 0)); }
  bool is_known(std::size_t k) const { return is_value_end(k) || zero[k]; }
  bool is_value_end(std::size_t k) const {
    return (k == 0 && problem_.at_low.kind == Kind::value) ||
           (k == last() && problem_.at_high.kind == Kind::value);
  }
  double known_value(std::size_t k) const {
    if (zero[k] && !is_value_end(k)) return 0;
    return k == 0 ? problem_.at_low.value : problem_.at_high.value;
  }
  /// p in a cell falls below the lesser of its ends by at most ∫ G |h| w, Green's function G being at most a
  /// quarter of the cell's resistance; twice that, for the rounding.
  double largest_dip(std::size_t cell) const { return 0.5 * cells[cell].resistance * cells[cell].absolute; }
  bool has_many() const { return static_cast<Index>(cells.size()) > problem_.most_cells; }
  double known_error() const { return rounding_ + unresolved_; }

 private:
  double low_flux(std::size_t node) const {
    return node == 1 && first() == 1 ? -cells[0].load : -end_flux(problem_.at_low, node);
  }
  double flux_below(std::size_t k) const {
    if (k == first()) return low_flux(k);
    return flux[k - 1] - cells[k - 1].load;
  }
  double flux_above(std::size_t k) const { return k == last() ? end_flux(problem_.at_high, k) : flux[k]; }

  void put(double a, double b) {
    cells.push_back(cell_load(problem_.h, w_, a, b));
    r.push_back(b);
  }
  /// What the quadrature may miss in [a, b], in p: of a mass m Green's function makes at most m times the
  /// length of the line, wherever it is, since the weight grows.
  double hidden(double a, double b) const {
    const double departs = problem_.departure(a, b);
    return std::isnan(departs) ? infinity : departs * (b - a) * (problem_.high - problem_.low);
  }
  /// The same by what h can sum up to, where it has no bound itself.
  double hidden_mass(double a, double b, const CellLoad& taken) const {
    return 2 * (problem_.mass(a, b) + taken.absolute) * (problem_.high - problem_.low);
  }
  /// Where no departure is known: whether h leaves the polynomial through the points of the rule between the
  /// outer ones and the ends. A jump there changes neither the rule's sum nor those of the halves.
  bool leaves_at_ends(double a, double b, const CellLoad& whole) const {
    constexpr double part = 0x1p-30;  // of the mean; what is so small makes less of p than is asked for
    if (problem_.departure) return false;
    const double counted = part * whole.absolute / (b - a);
    return !(std::abs(w_(a) * problem_.h(a) - whole.at_low) <= counted &&
             std::abs(w_(b) * problem_.h(b) - whole.at_high) <= counted);
  }
  double seen() const { return resolved_ + 0x1p-50 * ends_ / first_cells; }
  /// [a, b], in parts on which the rule is exact to rounding.
  void add(double a, double b, const CellLoad& whole) {
    const double middle = 0.5 * (a + b);
    const CellLoad low = cell_load(problem_.h, w_, a, middle), high = cell_load(problem_.h, w_, middle, b);
    const double R = high.resistance;
    const double load = low.load + high.load, moment = low.load * R + low.moment + high.moment;
    // Of h at points that are rounded themselves.
    const double noise = rounding * whole.variation * std::max(std::abs(a), std::abs(b));
    const double noise_of_moment = whole.absolute > 0 ? noise * (whole.absolute_moment / whole.absolute) : 0;
    const bool is_exact =
        !leaves_at_ends(a, b, whole) &&
        std::abs(whole.moment - moment) <= resolved_ + rounding * whole.absolute_moment + noise_of_moment &&
        std::abs(whole.load - load) * (b - a) <=
            (resolved_ + rounding * whole.absolute * (b - a)) * w_(b) + noise * (b - a);
    const double missed = has_departures_ ? hidden(a, b) : 0;
    if ((is_exact && missed <= seen()) || b - a <= shortest_ || has_many()) {
      cells.push_back(whole);
      r.push_back(b);
      unresolved_ += is_exact ? 0 : std::abs(whole.moment - moment);
      unresolved_ += noise / w_(b) * (problem_.high - problem_.low);
      if (missed > seen())
        unresolved_ += std::isinf(missed) && problem_.mass ? hidden_mass(a, b, whole) : missed;
      return;
    }
    add(a, middle, low);
    add(middle, b, high);
  }

  const LineObstacle& problem_;
  LineWeight w_;
  bool one_sided_;
  bool has_departures_ = false;
  double ends_ = 0;  // the size of what is given there, in p
  double shortest_ = 0, resolved_ = 0, rounding_ = 0, unresolved_ = 0;
  std::vector<double> slack_;
};

}  // namespace

LineSolution solve_line(const LineObstacle& problem, bool one_sided) {
  LineSolution found;
  found.problem_ = problem;
  LineCells cells(problem, one_sided);
  const bool unfixed = problem.at_low.kind != Kind::value && problem.at_high.kind != Kind::value;
  bool balanced = false;
  if (unfixed) {
    const auto [surplus, slack] = cells.surplus();
    found.surplus = std::abs(surplus) <= slack ? 0 : surplus;
    if (found.surplus > 0) {
      found.status = LineSolution::Status::infeasible;
      return found;
    }
    balanced = found.surplus == 0 || !one_sided;
    if (!balanced) cells.zero.assign(cells.r.size(), true);
  }
  if (balanced) {
    cells.solve();
    double least = cells.p[cells.first()];
    for (std::size_t k = cells.first(); k < cells.r.size(); ++k) least = std::min(least, cells.p[k]);
    for (double& p : cells.p) p -= least;
  } else {
    for (int round = 0; round < most_rounds; ++round) {
      cells.solve_obstacle();
      if (!one_sided || !cells.refine()) break;
    }
  }
  found.low_parts =
      problem.at_low.kind == Kind::flux && cells.zero.front() && cells.push(0) > cells.push_slack(0);
  found.high_parts = problem.at_high.kind == Kind::flux && cells.zero.back() &&
                     cells.push(cells.last()) > cells.push_slack(cells.last());
  found.error_bound = cells.known_error();
  found.nodes = static_cast<Index>(cells.r.size());
  found.held_.resize(cells.r.size());
  for (std::size_t k = 0; k < cells.r.size(); ++k) found.held_[k] = cells.is_zero(k);
  if (cells.first() == 1) found.held_[0] = found.held_[1];
  found.r_ = std::move(cells.r);
  found.p_ = std::move(cells.p);
  found.flux_ = std::move(cells.flux);
  if (balanced) {
    const double least = found.least().value;
    for (double& p : found.p_) p -= least;
  }
  return found;
}

}  // namespace convex::inline obstacle_problem
