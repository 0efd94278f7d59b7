#include "convex/operations/open_domain.hpp"

#include <cmath>

#include "convex/composite/epigraph.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/linear_quadratic/properness.hpp"

namespace convex::inline operations {
namespace {

/// A row a·(ξ, τ) >= bound.
struct DomainRow {
  std::vector<std::pair<Index, double>> entries;
  double bound = 0;
  bool equation = false;
};

/// Is f, a sum over its entries or the epigraph of one, +inf wherever entry i is `end`? It is where the
/// other entries are inside its domain.
bool is_open_at(const Atom& f, Index n, Index i, double end) {
  if (const auto above = parts_of_epigraph(f)) return i < n - 1 && is_open_at(*above->f, n - 1, i, end);
  if (!f.facts().separable) return false;
  Vector at = f.prox_diagonal(Vector::Zero(n), Vector::Ones(n));
  at[i] = end;
  return std::isinf(f.value(at));
}

/// The rows of all terms in (ξ, their programs' auxiliary variables, τ), τ the column `last`.
class DomainRows {
 public:
  DomainRows(const GraphForm& f, Index last) : last_(last), next_(f.n + f.k) {
    for (const GraphTerm& term : f.terms) add(term);
    rows_.push_back({{{last_, 1}}, 1, false});
  }
  bool any_open() const { return open_; }
  const std::vector<DomainRow>& rows() const { return rows_; }

  static Index columns(const GraphForm& f) {
    Index count = f.n + f.k + 1;
    for (const GraphTerm& term : f.terms)
      if (const auto form = term.f->linear_quadratic(term.M.rows())) count += form->auxiliaries();
    return count;
  }

 private:
  void add(const GraphTerm& term) {
    const Index m = term.M.rows();
    if (term.f->facts().finite) return;
    const SparseRows M = term.M;
    if (const auto form = term.f->linear_quadratic(m)) {
      std::vector<bool> equation(static_cast<std::size_t>(form->rows()), false);
      for (const Index a : form->two_sided) equation[static_cast<std::size_t>(a)] = true;
      for (Index a = 0; a < form->rows(); ++a) {
        DomainRow row;
        double shift = -form->h[a];
        for (SparseRows::InnerIterator entry(form->G, a); entry; ++entry) {
          if (entry.col() < m) {
            along(row, M, entry.col(), entry.value());
            shift += entry.value() * term.b[entry.col()];
          } else {
            row.entries.emplace_back(next_ + entry.col() - m, entry.value());
          }
        }
        row.entries.emplace_back(last_, shift);
        row.equation = equation[static_cast<std::size_t>(a)];
        rows_.push_back(std::move(row));
      }
      next_ += form->auxiliaries();
      return;
    }
    for (Index i = 0; i < m; ++i)
      for (const double side : {1.0, -1.0}) {
        const double most = term.f->domain_support(side * Vector::Unit(m, i));
        if (!std::isfinite(most)) continue;
        DomainRow row;  // side u_i <= most
        along(row, M, i, -side);
        row.entries.emplace_back(last_, most - side * term.b[i]);
        if (is_open_at(*term.f, m, i, side * most)) {
          row.bound = 1;
          open_ = true;
        }
        rows_.push_back(std::move(row));
      }
  }

  /// Adds factor · (row i of M) to the row.
  static void along(DomainRow& row, const SparseRows& M, Index i, double factor) {
    for (SparseRows::InnerIterator entry(M, i); entry; ++entry)
      row.entries.emplace_back(entry.col(), factor * entry.value());
  }

  Index last_, next_;
  bool open_ = false;
  std::vector<DomainRow> rows_;
};

}  // namespace

bool has_empty_open_domain(const GraphForm& f) {
  const Index columns = DomainRows::columns(f);
  const DomainRows domain(f, columns - 1);
  if (!domain.any_open()) return false;
  LinearQuadraticBuilder program(columns, 0);
  for (const DomainRow& row : domain.rows()) {
    row.equation ? program.equation(row.bound) : program.row(row.bound);
    for (const auto& [column, value] : row.entries) program.entry(column, value);
  }
  return properness(program.finish()) == linear_quadratic::Defect::empty_domain;
}

}  // namespace convex::inline operations
