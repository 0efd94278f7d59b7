#include "convex/composite/receding_directions.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/epigraph.hpp"
#include "convex/exact_program/exact_minimum.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/linear_quadratic/operations.hpp"

namespace convex::inline composite {
namespace {

/// Programs beyond this many variables and rows are not looked at: looking should cost no more than a prox.
constexpr std::size_t most_unknowns = 200;

/// A program's simplex steps, each a product of its basis, as evaluations.
long work_of(std::size_t rows) {
  constexpr double products_an_evaluation = 16;
  const auto size = static_cast<double>(rows);
  return static_cast<long>(size * size * size / products_an_evaluation);
}

/// Is f a sum of curved functions of one entry, which may come to lines?
bool is_curved_sum(const Atom& f) {
  const Facts facts = f.facts();
  return facts.separable && !facts.piecewise_quadratic;
}

std::vector<ExactRow> rows_of(const SparseRows& M) {
  std::vector<ExactRow> rows(static_cast<std::size_t>(M.rows()));
  for (Index i = 0; i < M.rows(); ++i)
    for (SparseRows::InnerIterator entry(M, i); entry; ++entry)
      if (entry.value() != 0)
        add(rows[static_cast<std::size_t>(i)], static_cast<std::size_t>(entry.col()),
            fraction(entry.value()));
  return rows;
}

}  // namespace

std::shared_ptr<const Atom> curved_sum(const GraphTerm& term) {
  if (is_curved_sum(*term.f)) return term.f;
  const auto epigraph = parts_of_epigraph(*term.f);
  return epigraph && is_curved_sum(*epigraph->f) ? epigraph->f : nullptr;
}

void SolvedEquations::take_out(ExactRow& row) const {
  for (const auto& [pivot, equation] : solved_)
    if (const auto at = row.find(pivot); at != row.end())
      add(row, equation, -(at->second / equation.at(pivot)));
}

void SolvedEquations::solve(ExactRow row) {
  take_out(row);
  if (row.empty()) return;
  const std::size_t pivot = row.begin()->first;
  solved_.emplace_back(pivot, std::move(row));
}

void SolvedEquations::fill(Fractions& xi) const {
  for (auto last = solved_.rbegin(); last != solved_.rend(); ++last) {
    const auto& [pivot, equation] = *last;
    xi[pivot] = {};
    xi[pivot] = -(dot(equation, xi) / equation.at(pivot));
  }
}

RecedingDirections::RecedingDirections(const GraphForm& f) : k_(static_cast<std::size_t>(f.k)), next_(k_) {
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
  settle_equations();
}

Fractions RecedingDirections::direction() const {
  Fractions d(next_);
  bool moves = false;
  std::vector<Side> sides;
  for (const CurvedEntry& entry : entries_)
    if (entry.up != entry.down) sides.push_back({&entry, entry.up ? 1.0 : -1.0});
  moves = take(sides, d) || moves;
  for (const CurvedEntry& entry : entries_)
    if (entry.up && entry.down) moves = take({{&entry, 1}}, d) || take({{&entry, -1}}, d) || moves;
  return moves ? d : Fractions{};
}

bool RecedingDirections::is_within_reach() const {
  return !entries_.empty() && next_ + rows_.size() <= most_unknowns;
}

ExactRow RecedingDirections::recession(const Atom& f, const std::vector<ExactRow>& u, std::size_t term) {
  const auto size = static_cast<Index>(u.size());
  ExactRow sum;
  if (const auto form = f.quadratic_form(size)) {
    const SparseRows Q = form->Q;
    for (Index i = 0; i < size; ++i) {
      ExactRow image;
      for (SparseRows::InnerIterator entry(Q, i); entry; ++entry)
        add(image, u[static_cast<std::size_t>(entry.col())], fraction(entry.value()));
      equations_.solve(image);
      if (form->c[i] != 0) add(sum, u[static_cast<std::size_t>(i)], fraction(form->c[i]));
    }
  } else if (f.facts().separable) {
    for (Index i = 0; i < size; ++i)
      add(sum, recession_of_entry(f, i, u[static_cast<std::size_t>(i)], size, term), fraction(1));
  } else if (const auto program = f.linear_quadratic(size)) {
    sum = recession_of_program(linear_quadratic::recession(*program), u);
  } else {
    for (const ExactRow& entry : u) equations_.solve(entry);
  }
  return sum;
}

ExactRow RecedingDirections::recession_of_entry(const Atom& f, Index i, const ExactRow& u, Index size,
                                                std::size_t term) {
  ExactRow sum;
  if (u.empty()) return sum;
  const double up = f.recession(Vector::Unit(size, i)), down = f.recession(-Vector::Unit(size, i));
  const bool has_up = std::isfinite(up), has_down = std::isfinite(down);
  if (is_curved_sum(f) && (has_up || has_down)) entries_.push_back({term, i, u, has_up, has_down});
  if (!has_up && !has_down) {
    equations_.solve(u);
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

ExactRow RecedingDirections::recession_of_program(const LinearQuadratic& cone,
                                                  const std::vector<ExactRow>& u) {
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
    if (std::binary_search(cone.two_sided.begin(), cone.two_sided.end(), a))
      equations_.solve(std::move(row));
    else
      rows_.push_back({std::move(row), {}, false});
  }
  ExactRow sum;
  for (Index j = 0; j < cone.variables(); ++j)
    if (cone.c[j] != 0) add_variable(sum, j, cone.c[j]);
  return sum;
}

void RecedingDirections::settle_equations() {
  std::erase_if(entries_, [&](CurvedEntry& entry) {
    equations_.take_out(entry.u);
    return entry.u.empty();
  });
  for (ExactBound& bound : rows_) equations_.take_out(bound.row);
  std::erase_if(rows_, [](const ExactBound& bound) { return bound.row.empty(); });
  equations_.take_out(total_);
}

bool RecedingDirections::take(const std::vector<Side>& sides, Fractions& d) const {
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
  const long work = work_of(program.rows.size());
  if (!WorkLimit::has(work)) return false;
  WorkLimit::count(work);
  const auto found = graph_point_at(program, {});
  // Where F∞ is below 0, the infimum is -inf.
  if (!found || sign(found->f_x) == 0 || sign(dot(total_, found->xi)) < 0) return false;
  Fractions xi = found->xi;
  equations_.fill(xi);
  for (std::size_t i = 0; i < next_; ++i) d[i] = d[i] + xi[i];
  return true;
}

}  // namespace convex::inline composite
