#include "convex/composite/attained_infimum.hpp"

#include <cmath>

#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/epigraph.hpp"
#include "convex/composite/receding_directions.hpp"
#include "convex/gamma0/work_limit.hpp"

namespace convex::inline composite {
namespace {

/// s u - end.
struct Line {
  double slope = 0, end = 0;
};

/// The lines that entries of f come to along u; none where they end in no line.
std::optional<std::map<Index, Line>> lines_of(const Atom& f, Index size, const std::map<Index, int>& moved) {
  std::map<Index, Line> lines;
  for (const auto& [i, side] : moved) {
    const double slope = side * f.recession(side * Vector::Unit(size, i));
    const auto entry = f.entry(i);
    if (!entry || !std::isfinite(slope)) return std::nullopt;
    const Value end = entry->conjugate().evaluate(Vector::Constant(1, slope));
    if (!std::isfinite(end.value) || !(end.error <= accuracy_of_prox * std::max(1.0, std::abs(end.value))))
      return std::nullopt;
    lines[i] = {slope, end.value};
  }
  return lines;
}

/// A sum of functions of one entry without some of its entries.
struct Remaining {
  std::shared_ptr<const Atom> f;
  std::vector<Index> rows;
};

std::optional<std::vector<Remaining>> remaining_of(const std::shared_ptr<const Atom>& f, Index size,
                                                   const std::map<Index, Line>& lines) {
  std::vector<Remaining> parts;
  for (Index i = 0; i < size; ++i) {
    if (lines.contains(i)) continue;
    if (f->dimension() == 0) {
      if (parts.empty()) parts.push_back({f, {}});
      parts[0].rows.push_back(i);
      continue;
    }
    const auto entry = f->entry(i);
    auto atom = entry ? std::dynamic_pointer_cast<const Atom>(entry->shared()) : nullptr;
    if (!atom) return std::nullopt;
    parts.push_back({std::move(atom), {i}});
  }
  return parts;
}

SparseMatrix rows_taken(const SparseMatrix& M, const std::vector<Index>& rows) {
  SparseMatrix S(static_cast<Index>(rows.size()), M.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) S.insert(static_cast<Index>(i), rows[i]) = 1;
  return S * M;
}

Vector entries_taken(const Vector& b, const std::vector<Index>& rows) {
  Vector taken(static_cast<Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) taken[static_cast<Index>(i)] = b[rows[i]];
  return taken;
}

/// The slopes of the lines, 0 for the other entries, and the sum of the ends.
std::pair<Vector, double> sum_of_lines(Index size, const std::map<Index, Line>& lines) {
  std::pair<Vector, double> sum{Vector::Zero(size), 0};
  for (const auto& [i, line] : lines) {
    sum.first[i] = line.slope;
    sum.second += line.end;
  }
  return sum;
}

/// Adds the limit of a term that is a sum; false where it has none.
bool add_limit(GraphForm& made, const GraphTerm& term, const std::map<Index, int>& moved) {
  const Index size = term.M.rows();
  const auto lines = lines_of(*term.f, size, moved);
  const auto parts = lines ? remaining_of(term.f, size, *lines) : std::nullopt;
  if (!parts) return false;
  for (const Remaining& part : *parts)
    made.terms.push_back(
        {part.f, term.scale, rows_taken(term.M, part.rows), entries_taken(term.b, part.rows)});
  const auto [slopes, ends] = sum_of_lines(size, *lines);
  if (!slopes.isZero(0)) made.terms.push_back({linear_atom(slopes), term.scale, term.M, term.b});
  made.constant -= term.scale * ends;
  return true;
}

/// The same of the epigraph of one.
bool add_limit_of_epigraph(GraphForm& made, const GraphTerm& term, const std::map<Index, int>& moved) {
  const auto epigraph = parts_of_epigraph(*term.f);
  const Index size = term.M.rows() - 1;
  const auto lines = lines_of(*epigraph->f, size, moved);
  const auto parts = lines ? remaining_of(epigraph->f, size, *lines) : std::nullopt;
  if (!parts || parts->size() > 1) return false;
  // What is left of the height: side h - s·u + ends.
  auto [last, ends] = sum_of_lines(size + 1, *lines);
  const double side = parts->empty() ? 1 : epigraph->side;
  last *= -1 / side;
  last[size] = epigraph->side / side;
  const SparseMatrix row = Matrix(last.transpose() * Matrix(term.M)).sparseView();
  const Vector shift = Vector::Constant(1, last.dot(term.b) + ends / side);
  if (parts->empty()) {
    made.terms.push_back({orthant_atom(), 1, row, shift});
    return true;
  }
  const std::vector<Index>& kept = (*parts)[0].rows;
  const auto count = static_cast<Index>(kept.size());
  const SparseMatrix above = rows_taken(term.M, kept);
  Matrix M(count + 1, term.M.cols());
  M << Matrix(above), Matrix(row);
  Vector b(count + 1);
  b << entries_taken(term.b, kept), shift;
  made.terms.push_back({epigraph_atom((*parts)[0].f, count, side), 1, M.sparseView(), b});
  return true;
}

/// Does the height of an epigraph move by the recession function alone?
bool is_tight(const GraphTerm& term, const Vector& u) {
  const auto epigraph = parts_of_epigraph(*term.f);
  return !epigraph || epigraph->f->recession(u.head(u.size() - 1)) == epigraph->side * u[u.size() - 1];
}

}  // namespace

GraphForm with_attained_infimum(GraphForm f) {
  const auto part = WorkLimit::half_of_the_rest();  // the infimum itself is to have some
  const auto may_recede = [&] {
    return f.k > 0 && std::any_of(f.terms.begin(), f.terms.end(),
                                  [](const GraphTerm& term) { return curved_sum(term) != nullptr; });
  };
  while (may_recede()) {
    const RecedingDirections directions(f);
    if (!directions.is_within_reach()) break;
    const Fractions d = directions.direction();
    if (d.empty()) break;
    std::vector<std::map<Index, int>> moved(f.terms.size());
    for (const CurvedEntry& entry : directions.entries())
      if (const int side = sign(dot(entry.u, d)); side != 0) moved[entry.term][entry.row] = side;
    Vector whole = Vector::Zero(f.n + f.k);
    for (Index i = 0; i < f.k; ++i) whole[f.n + i] = nearest_double(d[static_cast<std::size_t>(i)]);
    GraphForm made{f.n, f.k, {}, f.constant, f.by_slope, f.by_point};
    bool changed = false;
    for (std::size_t j = 0; j < f.terms.size(); ++j) {
      const GraphTerm& term = f.terms[j];
      const bool limited = !moved[j].empty() && is_tight(term, term.M * whole) &&
                           (parts_of_epigraph(*term.f) ? add_limit_of_epigraph(made, term, moved[j])
                                                       : add_limit(made, term, moved[j]));
      if (!limited) made.terms.push_back(term);
      changed = changed || limited;
    }
    if (!changed) break;
    f = std::move(made);
  }
  return f;
}

}  // namespace convex::inline composite
