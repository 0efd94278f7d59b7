#include "convex/composite/attained_infimum.hpp"

#include <cmath>

#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/epigraph.hpp"
#include "convex/exact_program/exact_minimum.hpp"
#include "convex/linear_quadratic/operations.hpp"

namespace convex::inline composite {
namespace {

/// Programs beyond this many variables and rows are not looked at: looking should cost no more than a prox.
constexpr std::size_t most_unknowns = 200;

/// An entry of a curved function whose slope far out is finite on one side at least: where it moves to that
/// side, it comes to a line.
struct CurvedEntry {
  std::size_t term;
  Index row;
  ExactRow u;
  bool up, down;  ///< the sides
};

/// Is f a sum of curved functions of one entry, which may come to lines?
bool is_curved_sum(const Atom& f) {
  const Facts facts = f.facts();
  return facts.separable && !facts.piecewise_quadratic;
}

/// The part of a term that is a sum over its entries: itself, or the function of an epigraph; null elsewhere.
std::shared_ptr<const Atom> curved_sum(const GraphTerm& term) {
  if (is_curved_sum(*term.f)) return term.f;
  const auto epigraph = parts_of_epigraph(*term.f);
  return epigraph && is_curved_sum(*epigraph->f) ? epigraph->f : nullptr;
}

/// The directions d of w with F∞(0, d) <= 0, by rows over d and auxiliary variables.
class RecedingDirections {
 public:
  explicit RecedingDirections(const GraphForm& f) : k_(static_cast<std::size_t>(f.k)), next_(k_) {
    ExactRow total;
    for (std::size_t j = 0; j < f.terms.size(); ++j) {
      const GraphTerm& term = f.terms[j];
      std::vector<ExactRow> u = rows_of(SparseRows(term.M.rightCols(f.k)));
      if (const auto epigraph = parts_of_epigraph(*term.f)) {
        const ExactRow height = std::move(u.back());
        u.pop_back();
        ExactRow left;
        add(left, height, fraction(epigraph->side));
        add(left, recession(*epigraph->f, u, j), fraction(-1));
        rows_.push_back({std::move(left), {}, false});
      } else {
        add(total, recession(*term.f, u, j), fraction(term.scale));
      }
    }
    total_ = total;
    ExactRow least;
    add(least, total, fraction(-1));
    rows_.push_back({std::move(least), {}, false});
  }

  /// One along which as many of the curved entries move to a line as can; empty where none can.
  Fractions direction() const {
    Fractions d(k_);
    bool moves = false;
    std::vector<Side> sides;
    for (const CurvedEntry& entry : entries_)
      if (entry.up != entry.down) sides.push_back({&entry, entry.up ? 1.0 : -1.0});
    moves = take(sides, d) || moves;
    for (const CurvedEntry& entry : entries_)
      if (entry.up && entry.down) moves = take({{&entry, 1}}, d) || take({{&entry, -1}}, d) || moves;
    return moves ? d : Fractions{};
  }

  const std::vector<CurvedEntry>& entries() const { return entries_; }
  bool is_within_reach() const { return !entries_.empty() && next_ + rows_.size() <= most_unknowns; }

 private:
  struct Side {
    const CurvedEntry* entry;
    double sign;
  };

  static std::vector<ExactRow> rows_of(const SparseRows& M) {
    std::vector<ExactRow> rows(static_cast<std::size_t>(M.rows()));
    for (Index i = 0; i < M.rows(); ++i)
      for (SparseRows::InnerIterator entry(M, i); entry; ++entry)
        if (entry.value() != 0)
          add(rows[static_cast<std::size_t>(i)], static_cast<std::size_t>(entry.col()),
              fraction(entry.value()));
    return rows;
  }

  void stand_still(const ExactRow& u) {
    if (!u.empty()) rows_.push_back({u, {}, true});
  }

  /// What is at least f∞(u) under the rows that are added, and is f∞(u) where they are tight.
  ExactRow recession(const Atom& f, const std::vector<ExactRow>& u, std::size_t term) {
    const auto size = static_cast<Index>(u.size());
    ExactRow sum;
    if (const auto form = f.quadratic_form(size)) {
      const SparseRows Q = form->Q;
      for (Index i = 0; i < size; ++i) {
        ExactRow image;
        for (SparseRows::InnerIterator entry(Q, i); entry; ++entry)
          add(image, u[static_cast<std::size_t>(entry.col())], fraction(entry.value()));
        stand_still(image);
        if (form->c[i] != 0) add(sum, u[static_cast<std::size_t>(i)], fraction(form->c[i]));
      }
    } else if (f.facts().separable) {
      for (Index i = 0; i < size; ++i)
        add(sum, recession_of_entry(f, i, u[static_cast<std::size_t>(i)], size, term), fraction(1));
    } else if (const auto program = f.linear_quadratic(size)) {
      sum = recession_of_program(linear_quadratic::recession(*program), u);
    } else {
      for (const ExactRow& entry : u) stand_still(entry);
    }
    return sum;
  }

  ExactRow recession_of_entry(const Atom& f, Index i, const ExactRow& u, Index size, std::size_t term) {
    ExactRow sum;
    if (u.empty()) return sum;
    const double up = f.recession(Vector::Unit(size, i)), down = f.recession(-Vector::Unit(size, i));
    const bool has_up = std::isfinite(up), has_down = std::isfinite(down);
    if (is_curved_sum(f) && (has_up || has_down)) entries_.push_back({term, i, u, has_up, has_down});
    if (!has_up && !has_down) {
      stand_still(u);
    } else if (has_up && has_down && up != -down) {
      const std::size_t above = next_++;
      for (const double slope : {up, -down}) {
        ExactRow row{{above, fraction(1)}};
        add(row, u, fraction(-slope));
        rows_.push_back({std::move(row), {}, false});
      }
      sum[above] = fraction(1);
    } else {
      if (has_up != has_down) {
        ExactRow side;
        add(side, u, fraction(has_up ? 1 : -1));
        rows_.push_back({std::move(side), {}, false});
      }
      add(sum, u, fraction(has_up ? up : -down));
    }
    return sum;
  }

  ExactRow recession_of_program(const LinearQuadratic& cone, const std::vector<ExactRow>& u) {
    const std::size_t first = next_;
    next_ += static_cast<std::size_t>(cone.auxiliaries());
    const auto add_variable = [&](ExactRow& row, Index j, double factor) {
      if (j < cone.n)
        add(row, u[static_cast<std::size_t>(j)], fraction(factor));
      else
        add(row, first + static_cast<std::size_t>(j - cone.n), fraction(factor));
    };
    for (Index a = 0; a < cone.rows(); ++a) {
      ExactRow row;
      for (SparseRows::InnerIterator entry(cone.G, a); entry; ++entry)
        add_variable(row, entry.col(), entry.value());
      if (row.empty()) continue;
      const bool equation = std::binary_search(cone.two_sided.begin(), cone.two_sided.end(), a);
      rows_.push_back({std::move(row), {}, equation});
    }
    ExactRow sum;
    for (Index j = 0; j < cone.variables(); ++j)
      if (cone.c[j] != 0) add_variable(sum, j, cone.c[j]);
    return sum;
  }

  /// Adds to d a direction along which as many of these entries as can move to the sides told.
  bool take(const std::vector<Side>& sides, Fractions& d) const {
    if (sides.empty()) return false;
    ExactProgram program(0, next_ + sides.size());
    program.rows = rows_;
    for (std::size_t s = 0; s < sides.size(); ++s) {
      const std::size_t moved = next_ + s;  // as far as 1
      program.c[moved] = fraction(-1);
      program.bound({{moved, fraction(1)}}, {});
      program.bound({{moved, fraction(-1)}}, fraction(-1));
      ExactRow row;
      add(row, sides[s].entry->u, fraction(sides[s].sign));
      add(row, moved, fraction(-1));
      program.bound(std::move(row), {});
    }
    const auto found = graph_point_at(program, {});
    // Where F∞ is below 0, the infimum is -inf.
    if (!found || sign(found->f_x) == 0 || sign(dot(total_, found->xi)) < 0) return false;
    for (std::size_t i = 0; i < k_; ++i) d[i] = d[i] + found->xi[i];
    return true;
  }

  std::size_t k_, next_;
  ExactRow total_;
  std::vector<ExactBound> rows_;
  std::vector<CurvedEntry> entries_;
};

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
    GraphForm made{f.n, f.k, {}, f.constant, f.by_slope};
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
