#include "mechanics/liquid/grid_pressure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mechanics::liquid {
namespace {

using convex::CutPoint;
using convex::Index;

constexpr std::size_t most_terms = 10;

/// Solves the normal equations M c = b of n terms by Gaussian elimination with pivots; false when singular.
bool eliminate(std::array<std::array<double, most_terms>, most_terms>& M, std::array<double, most_terms>& b,
               std::size_t n) {
  constexpr double singular = 1e-10;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i)
      if (std::abs(M[i][k]) > std::abs(M[pivot][k])) pivot = i;
    if (!(std::abs(M[pivot][k]) > singular)) return false;
    std::swap(M[k], M[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double part = M[i][k] / M[k][k];
      for (std::size_t j = k; j < n; ++j) M[i][j] -= part * M[k][j];
      b[i] -= part * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= M[k][j] * b[j];
    b[k] /= M[k][k];
  }
  return true;
}

}  // namespace

GridPressure::GridPressure(CutCells cells, std::vector<double> q)
    : cells_(std::move(cells)), q_(std::move(q)) {
  std::sort(cells_.pressures.begin(), cells_.pressures.end(),
            [](const GivenPressure& a, const GivenPressure& b) { return a.from < b.from; });
}

double GridPressure::at_node(Index k) const {
  const auto i = static_cast<std::size_t>(k);
  if (cells_.grid.kind[i] == CutPoint::bounded) return q_[i];
  return cells_.given[i];
}

std::vector<GridPressure::Known> GridPressure::around(const Point& x, double reach) const {
  const std::size_t d = cells_.grid.dimension;
  std::array<Index, 3> low{0, 0, 0}, high{0, 0, 0};
  for (std::size_t i = 0; i < d; ++i) {
    const double here = (x[i] - cells_.low[i]) / cells_.step[i];
    low[i] = std::max<Index>(0, static_cast<Index>(std::ceil(here - reach)));
    high[i] = std::min<Index>(cells_.grid.points[i] - 1, static_cast<Index>(std::floor(here + reach)));
  }
  std::vector<Known> found;
  const auto offer = [&](const Point& at, double p) {
    double square = 0;
    for (std::size_t i = 0; i < d; ++i) {
      const double steps = (at[i] - x[i]) / cells_.step[i];
      square += steps * steps;
    }
    if (square >= reach * reach) return;
    const double fall = 1 - square / (reach * reach);
    found.push_back({at, p, fall * fall / (square + 0.05)});
  };
  for (Index c = low[2]; c <= high[2]; ++c)
    for (Index b = low[1]; b <= high[1]; ++b)
      for (Index a = low[0]; a <= high[0]; ++a) {
        const Index k = cells_.grid.at(a, b, c);
        const double p = at_node(k);
        if (std::isnan(p)) continue;
        offer(cells_.at(k), p);
        const auto first = std::lower_bound(cells_.pressures.begin(), cells_.pressures.end(), k,
                                            [](const GivenPressure& g, Index from) { return g.from < from; });
        for (auto given = first; given != cells_.pressures.end() && given->from == k; ++given)
          if (cells_.grid.is_unknown(k)) offer(given->at, given->pressure);
      }
  return found;
}

double GridPressure::operator()(const Point& x) const {
  const std::size_t d = cells_.grid.dimension;
  std::array<Index, 3> nearest{0, 0, 0};
  double off = 0;
  for (std::size_t i = 0; i < d; ++i) {
    const double here = (x[i] - cells_.low[i]) / cells_.step[i];
    nearest[i] = std::clamp<Index>(std::lround(here), 0, cells_.grid.points[i] - 1);
    off = std::max(off, std::abs(here - static_cast<double>(nearest[i])));
  }
  constexpr double on_node = 1e-9;
  if (off < on_node)
    if (const double p = at_node(cells_.grid.at(nearest[0], nearest[1], nearest[2])); !std::isnan(p))
      return p;
  for (const double reach : {2.3, 3.3, 4.3})
    for (const std::size_t degree : {std::size_t{2}, std::size_t{1}, std::size_t{0}}) {
      const std::size_t terms = degree == 0 ? 1 : degree == 1 ? 1 + d : 1 + d + d * (d + 1) / 2;
      const std::vector<Known> known = around(x, reach);
      if (known.size() < terms + (degree == 2 ? 1 : 0)) continue;
      std::array<std::array<double, most_terms>, most_terms> M{};
      std::array<double, most_terms> b{};
      double total = 0;
      for (const Known& one : known) {
        std::array<double, most_terms> term{1};
        std::size_t n = 1;
        std::array<double, 3> s{};
        for (std::size_t i = 0; i < d; ++i) s[i] = (one.at[i] - x[i]) / cells_.step[i];
        if (degree > 0)
          for (std::size_t i = 0; i < d; ++i) term[n++] = s[i];
        if (degree > 1)
          for (std::size_t i = 0; i < d; ++i)
            for (std::size_t j = i; j < d; ++j) term[n++] = s[i] * s[j];
        for (std::size_t i = 0; i < n; ++i) {
          for (std::size_t j = 0; j < n; ++j) M[i][j] += one.weight * term[i] * term[j];
          b[i] += one.weight * term[i] * one.p;
        }
        total += one.weight;
      }
      for (std::size_t i = 0; i < terms; ++i) {
        for (std::size_t j = 0; j < terms; ++j) M[i][j] /= total;
        b[i] /= total;
      }
      if (eliminate(M, b, terms)) return std::max(0.0, b[0]);
      if (degree == 0) break;
    }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace mechanics::liquid
