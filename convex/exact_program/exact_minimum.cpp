#include "convex/exact_program/exact_minimum.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "convex/exact_program/cgal_program.hpp"
#include "convex/exact_program/linear_equations.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"
#include "convex/linear_quadratic/minimise.hpp"

namespace convex::inline exact_programs {
namespace {

/// Rows taken in or dropped before CGAL is asked.
constexpr int most_repairs = 8;

/// A part of a program that shares no row or curvature with the rest, and where its variables and rows are.
struct Part {
  ExactProgram program;
  std::vector<std::size_t> variables, rows;
};

class Partition {
 public:
  explicit Partition(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) { parent_[root(i)] = root(j); }

 private:
  std::vector<std::size_t> parent_;
};

/// The independent parts of f, x first in each; coupled by W too when there is one.
std::vector<Part> parts_of(const ExactProgram& f, const ExactGram* W) {
  Partition partition(f.variables());
  for (std::size_t i = 0; i < f.variables(); ++i)
    for (const auto& [j, value] : f.H[i]) partition.join(i, j);
  if (W != nullptr)
    for (std::size_t i = 0; i < f.n; ++i)
      for (const auto& [j, value] : W->rows[i]) partition.join(i, j);
  for (const ExactBound& bound : f.rows)
    for (const auto& [j, value] : bound.row) partition.join(j, bound.row.begin()->first);
  std::map<std::size_t, std::size_t> number;
  std::vector<Part> parts;
  std::vector<std::size_t> of(f.variables()), place(f.variables());
  for (std::size_t i = 0; i < f.variables(); ++i) {
    const auto [at, is_new] = number.try_emplace(partition.root(i), parts.size());
    if (is_new) parts.emplace_back();
    of[i] = at->second;
    Part& part = parts[of[i]];
    place[i] = part.variables.size();
    part.variables.push_back(i);
    if (i < f.n) ++part.program.n;
  }
  const auto moved = [&](const ExactRow& row) {
    ExactRow made;
    for (const auto& [j, value] : row) made[place[j]] = value;
    return made;
  };
  for (Part& part : parts)
    for (std::size_t i : part.variables) {
      part.program.H.push_back(moved(f.H[i]));
      part.program.c.push_back(f.c[i]);
    }
  for (std::size_t a = 0; a < f.rows.size(); ++a) {
    // A row without entries belongs to any part.
    Part& part = parts[f.rows[a].row.empty() ? 0 : of[f.rows[a].row.begin()->first]];
    part.rows.push_back(a);
    part.program.rows.push_back({moved(f.rows[a].row), f.rows[a].limit, f.rows[a].two_sided});
  }
  return parts;
}

struct Pair {
  Fractions xi, lambda;
};

/// Stationarity of ½||x - z||_W² + f, W in H and -Wz in c already: in all variables, or in w alone.
enum class Stationary { everywhere, in_auxiliaries };

/// The unknowns are ξ and, from column[a] on, the multipliers of the working set.
std::vector<ExactEquation> equations_of(const ExactProgram& f, const std::vector<bool>& held,
                                        const std::vector<std::size_t>& column, Stationary where) {
  const std::size_t N = f.variables();
  std::vector<ExactEquation> equations;
  const std::size_t first = where == Stationary::everywhere ? 0 : f.n;
  for (std::size_t i = first; i < N; ++i) equations.push_back({f.H[i], -f.c[i]});
  for (std::size_t a = 0; a < f.rows.size(); ++a) {
    if (!held[a]) continue;
    equations.push_back({f.rows[a].row, f.rows[a].limit});
    for (const auto& [j, value] : f.rows[a].row)
      if (j >= first) add(equations[j - first].row, column[a], -value);
  }
  return equations;
}

/// ξ and lambda of the working set, near the guess; rows are dropped and taken in while signs ask for it.
std::optional<Pair> repaired(const ExactProgram& f, const Vector& xi, const Vector& lambda,
                             Stationary where) {
  const std::size_t N = f.variables(), m = f.rows.size();
  std::vector<bool> held(m);
  for (std::size_t a = 0; a < m; ++a) held[a] = f.rows[a].two_sided || lambda[static_cast<Index>(a)] > 0;
  for (int repair = 0; repair < most_repairs; ++repair) {
    Fractions guess(N);
    for (std::size_t i = 0; i < N; ++i) guess[i] = fraction(xi[static_cast<Index>(i)]);
    std::vector<std::size_t> column(m);
    for (std::size_t a = 0; a < m; ++a) {
      if (!held[a]) continue;
      column[a] = guess.size();
      guess.push_back(fraction(lambda[static_cast<Index>(a)]));
    }
    const auto u = solve_near(equations_of(f, held, column, where), guess);
    if (!u) return std::nullopt;
    Pair found{{u->begin(), u->begin() + static_cast<std::ptrdiff_t>(N)}, Fractions(m)};
    for (std::size_t a = 0; a < m; ++a)
      if (held[a]) found.lambda[a] = (*u)[column[a]];
    bool right = true;
    for (std::size_t a = 0; a < m; ++a) {
      if (!held[a]) {
        if (dot(f.rows[a].row, found.xi) < f.rows[a].limit) held[a] = true, right = false;
      } else if (!f.rows[a].two_sided && sign(found.lambda[a]) < 0) {
        held[a] = right = false;
      }
    }
    if (right) return found;
  }
  return std::nullopt;
}

Vector nearest_of(const Fractions& x) {
  Vector made(static_cast<Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) made[static_cast<Index>(i)] = nearest_double(x[i]);
  return made;
}

/// What doubles find of ½||x - z||_W² + f; none when they fail.
std::optional<linear_quadratic::ProgramPoint> in_doubles(const ExactProgram& f, const Metric& W,
                                                         const Vector& z) {
  try {
    linear_quadratic::ProgramPoint point = minimise(rounded(f), W, z);
    if (point.xi.size() == static_cast<Index>(f.variables()) && point.xi.allFinite() &&
        point.lambda.size() == static_cast<Index>(f.rows.size()) && point.lambda.allFinite())
      return point;
  } catch (const InvalidInput&) {  // not definite once rounded: exact arithmetic decides
  }
  return std::nullopt;
}

void put(const Part& part, const Pair& found, Pair& whole) {
  for (std::size_t i = 0; i < part.variables.size(); ++i) whole.xi[part.variables[i]] = found.xi[i];
  for (std::size_t a = 0; a < part.rows.size(); ++a) whole.lambda[part.rows[a]] = found.lambda[a];
}

/// The minimum of a whole program, part by part: of f itself when W is null.
ExactMinimum minimum_of(const ExactProgram& f, const ExactGram* W, const Fractions& z) {
  Pair whole{Fractions(f.variables()), Fractions(f.rows.size())};
  for (const Part& part : parts_of(f, W)) {
    const std::size_t n = part.program.n;
    ExactProgram bent = part.program;
    Fractions target(n);
    ExactGram own;
    own.rows.resize(n);
    for (std::size_t i = 0; i < n; ++i) target[i] = z[part.variables[i]];
    if (W != nullptr) {
      std::map<std::size_t, std::size_t> place;
      for (std::size_t i = 0; i < n; ++i) place[part.variables[i]] = i;
      for (std::size_t i = 0; i < n; ++i)
        for (const auto& [j, value] : W->rows[part.variables[i]]) {
          own.rows[i][place.at(j)] = value;
          own.is_diagonal = own.is_diagonal && place.at(j) == i;
        }
      const Fractions pull = multiply(own, target);
      for (std::size_t i = 0; i < n; ++i) {
        add(bent.H[i], own.rows[i], Fraction{1});
        bent.c[i] = bent.c[i] - pull[i];
      }
    }
    std::optional<Pair> found;
    if (const auto guess = in_doubles(part.program, rounded(own), nearest_of(target)))
      found = repaired(bent, guess->xi, guess->lambda, Stationary::everywhere);
    if (!found) {
      const CgalAnswer answer = cgal_minimum(bent);
      if (answer.end != ProgramEnd::minimum) return {answer.end, std::nullopt};
      found = Pair{answer.xi, answer.lambda};
    }
    put(part, *found, whole);
  }
  ExactMinimum made;
  made.at = graph_point(f, whole.xi, whole.lambda);
  if (!made.at) return made;
  if (W == nullptr) return made;
  Fractions away(f.n);
  for (std::size_t i = 0; i < f.n; ++i) away[i] = z[i] - made.at->x[i];
  if (multiply(*W, away) != made.at->v) made.at.reset();
  return made;
}

}  // namespace

std::size_t largest_part(const ExactProgram& f, const ExactGram* W) {
  std::size_t largest = 0;
  for (const Part& part : parts_of(f, W)) largest = std::max(largest, part.variables.size());
  return largest;
}

namespace {

double entries_of(const std::vector<ExactRow>& rows) {
  double entries = 0;
  for (const ExactRow& row : rows) entries += static_cast<double>(row.size());
  return entries;
}

/// Of the parts of f: their unknowns times their nonzeros, summed, and the most unknowns.
struct SizeOfParts {
  double total = 0, most_unknowns = 0;
};

SizeOfParts size_of_parts(const ExactProgram& f, const ExactGram* W) {
  SizeOfParts made;
  for (const Part& part : parts_of(f, W)) {
    double entries = entries_of(part.program.H);
    for (const ExactBound& bound : part.program.rows) entries += static_cast<double>(bound.row.size());
    const auto unknowns = static_cast<double>(part.variables.size() + part.program.rows.size());
    made.total += entries * unknowns;
    made.most_unknowns = std::max(made.most_unknowns, unknowns);
  }
  return made;
}

}  // namespace

double pair_operations(const ExactProgram& f, const ExactGram& W) {
  constexpr double of_a_nonzero = 1000;  // in an unknown's digits, measured: both proofs, sums and repairs
  const SizeOfParts size = size_of_parts(f, nullptr);
  return of_a_nonzero * (size.total + entries_of(W.rows) * size.most_unknowns);
}

double split_operations(const ExactProgram& f, const ExactGram& W) {
  constexpr double of_a_nonzero = 50;  // in an unknown's digits, measured: both are solved modulo a prime
  const SizeOfParts size = size_of_parts(f, &W);
  return of_a_nonzero * (size.total + entries_of(W.rows) * size.most_unknowns);
}

std::optional<GraphPoint> graph_point(const ExactProgram& f, const Fractions& xi, const Fractions& lambda) {
  Fractions slope(f.variables());
  for (std::size_t i = 0; i < f.variables(); ++i) slope[i] = f.c[i] + dot(f.H[i], xi);
  Fraction limits;
  for (std::size_t a = 0; a < f.rows.size(); ++a) {
    const Fraction slack = dot(f.rows[a].row, xi) - f.rows[a].limit;
    if (f.rows[a].two_sided ? sign(slack) != 0 : sign(slack) < 0 || sign(lambda[a]) < 0) return std::nullopt;
    for (const auto& [j, value] : f.rows[a].row) slope[j] = slope[j] - value * lambda[a];
    limits = limits + f.rows[a].limit * lambda[a];
  }
  for (std::size_t i = f.n; i < f.variables(); ++i)
    if (sign(slope[i]) != 0) return std::nullopt;
  GraphPoint made{xi,
                  lambda,
                  Fractions(xi.begin(), xi.begin() + static_cast<std::ptrdiff_t>(f.n)),
                  Fractions(slope.begin(), slope.begin() + static_cast<std::ptrdiff_t>(f.n)),
                  {},
                  {}};
  const Fraction bent = half_square(f, xi);
  made.f_x = bent + dot(f.c, xi) + f.constant;
  made.f_v = bent - limits - f.constant;
  return made;
}

std::optional<GraphPoint> near_graph_point(const ExactProgram& f, const Vector& p) {
  Pair whole{Fractions(f.variables()), Fractions(f.rows.size())};
  for (const Part& part : parts_of(f, nullptr)) {
    const std::size_t n = part.program.n;
    Vector own(static_cast<Index>(n));
    for (std::size_t i = 0; i < n; ++i) own[static_cast<Index>(i)] = p[static_cast<Index>(part.variables[i])];
    const auto guess = in_doubles(part.program, Metric::identity(own.size()), own);
    if (!guess) return std::nullopt;
    const auto found = repaired(part.program, guess->xi, guess->lambda, Stationary::in_auxiliaries);
    if (!found) return std::nullopt;
    put(part, *found, whole);
  }
  return graph_point(f, whole.xi, whole.lambda);
}

ExactMinimum exact_prox(const ExactProgram& f, const ExactGram& W, const Fractions& z) {
  if (z.size() != W.dimension() || f.n != W.dimension())
    throw InvalidInput("prox: " + std::to_string(z.size()) + " entries; give " +
                       std::to_string(W.dimension()) + ", as many as f and the metric have");
  return minimum_of(f, &W, z);
}

namespace {

/// The program in w that x leaves of f, and the rows of f that are left in it; none where a row without w
/// does not hold.
struct Remainder {
  ExactProgram program;
  std::vector<std::size_t> rows;
};

std::optional<Remainder> remainder_at(const ExactProgram& f, const Fractions& x) {
  std::vector<ExactAffine> maps;
  for (std::size_t i = 0; i < f.variables(); ++i)
    maps.push_back(i < f.n ? ExactAffine{{}, x[i]} : ExactAffine{{{i - f.n, Fraction{1}}}, {}});
  Remainder left{substitute(f, maps, 0, f.variables() - f.n), {}};
  std::vector<ExactBound> rows;
  for (std::size_t a = 0; a < f.rows.size(); ++a) {
    ExactBound& bound = left.program.rows[a];
    if (!bound.row.empty()) {
      rows.push_back(std::move(bound));
      left.rows.push_back(a);
    } else if (bound.two_sided ? sign(bound.limit) != 0 : sign(bound.limit) > 0) {
      return std::nullopt;
    }
  }
  left.program.rows = std::move(rows);
  return left;
}

}  // namespace

std::optional<GraphPoint> graph_point_at(const ExactProgram& f, const Fractions& x) {
  const auto left = remainder_at(f, x);
  if (!left) return std::nullopt;
  Fractions xi = x, lambda(f.rows.size());
  if (left->program.variables() > 0) {
    const ExactMinimum found = minimum_of(left->program, nullptr, {});
    if (!found.at) return std::nullopt;
    xi.insert(xi.end(), found.at->xi.begin(), found.at->xi.end());
    for (std::size_t k = 0; k < left->rows.size(); ++k) lambda[left->rows[k]] = found.at->lambda[k];
  }
  return graph_point(f, xi, lambda);
}

ExactValue exact_value(const ExactProgram& f, const Fractions& x) {
  const auto left = remainder_at(f, x);
  if (!left) return {ProgramEnd::no_point, {}};
  if (left->program.variables() == 0) return {ProgramEnd::minimum, left->program.constant};
  const ExactMinimum found = minimum_of(left->program, nullptr, {});
  if (found.end != ProgramEnd::minimum) return {found.end, {}};
  invariant(found.at.has_value(), "a minimum in fractions satisfies its conditions");
  return {ProgramEnd::minimum, found.at->f_x};
}

}  // namespace convex::inline exact_programs
