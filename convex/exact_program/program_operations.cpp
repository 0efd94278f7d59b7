#include "convex/exact_program/program_operations.hpp"

namespace convex::inline exact_programs {
namespace {

using Maps = std::vector<ExactAffine>;

/// The variables of f among `columns`: x as `x_maps` say, the auxiliary ones from `first` on.
Maps placed_at(const ExactProgram& f, Maps x_maps, std::size_t first) {
  for (std::size_t k = f.n; k < f.variables(); ++k) x_maps.push_back({{{first + k - f.n, Fraction{1}}}, {}});
  return x_maps;
}

Maps identity_maps(std::size_t n, std::size_t first = 0) {
  Maps maps;
  for (std::size_t i = 0; i < n; ++i) maps.push_back({{{first + i, Fraction{1}}}, {}});
  return maps;
}

/// a x + b d, d the n variables behind x.
Maps along(std::size_t n, const Fraction& a, const Fraction& b) {
  Maps maps(n);
  for (std::size_t i = 0; i < n; ++i) {
    add(maps[i].row, i, a);
    add(maps[i].row, n + i, b);
  }
  return maps;
}

/// factor/2 ||d||_W² with d as the maps say.
ExactProgram half_square_of(const ExactGram& W, const Fraction& factor, const Maps& maps, std::size_t n,
                            std::size_t columns) {
  ExactProgram square(W.dimension(), 0);
  for (std::size_t i = 0; i < W.dimension(); ++i) add(square.H[i], W.rows[i], factor);
  return substitute(square, maps, n, columns);
}

std::size_t auxiliaries(const ExactProgram& f) { return f.variables() - f.n; }

}  // namespace

ExactProgram sum(std::span<const ExactProgram> terms) {
  const std::size_t n = terms.front().n;
  std::size_t columns = n;
  for (const ExactProgram& f : terms) columns += auxiliaries(f);
  ExactProgram total(n, columns - n);
  std::size_t first = n;
  for (const ExactProgram& f : terms) {
    total = add_joint(std::move(total), substitute(f, placed_at(f, identity_maps(n), first), n, columns));
    first += auxiliaries(f);
  }
  return total;
}

ExactProgram inf_convolution(const ExactProgram& f, const ExactProgram& g) {
  const std::size_t n = f.n, columns = 2 * n + auxiliaries(f) + auxiliaries(g);
  return add_joint(substitute(f, placed_at(f, along(n, Fraction{1}, Fraction{-1}), 2 * n), n, columns),
                   substitute(g, placed_at(g, identity_maps(n, n), 2 * n + auxiliaries(f)), n, columns));
}

ExactProgram precompose(const ExactProgram& f, const std::vector<ExactRow>& A, const Fractions& b,
                        std::size_t columns) {
  Maps maps;
  for (std::size_t i = 0; i < f.n; ++i) maps.push_back({A[i], b[i]});
  return substitute(f, placed_at(f, std::move(maps), columns), columns, columns + auxiliaries(f));
}

ExactProgram scale(ExactProgram f, const Fraction& alpha) {
  for (ExactRow& row : f.H)
    for (auto& [j, value] : row) value = value * alpha;
  for (Fraction& cost : f.c) cost = cost * alpha;
  f.constant = f.constant * alpha;
  return f;
}

ExactProgram dilate(const ExactProgram& f, const Fraction& rho) {
  Maps maps;
  for (std::size_t i = 0; i < f.n; ++i) maps.push_back({{{i, Fraction{1} / rho}}, {}});
  return substitute(f, placed_at(f, std::move(maps), f.n), f.n, f.variables());
}

ExactProgram translate(const ExactProgram& f, const Fractions& by) {
  Maps maps = identity_maps(f.n);
  for (std::size_t i = 0; i < f.n; ++i) maps[i].shift = -by[i];
  return substitute(f, placed_at(f, std::move(maps), f.n), f.n, f.variables());
}

ExactProgram tilt(ExactProgram f, const Fractions& v) {
  for (std::size_t i = 0; i < f.n; ++i) f.c[i] = f.c[i] + v[i];
  return f;
}

ExactProgram separable(std::span<const ExactProgram> blocks) {
  std::size_t n = 0, columns = 0;
  for (const ExactProgram& f : blocks) n += f.n, columns += f.variables();
  ExactProgram total(n, columns - n);
  std::size_t x = 0, first = n;
  for (const ExactProgram& f : blocks) {
    total =
        add_joint(std::move(total), substitute(f, placed_at(f, identity_maps(f.n, x), first), n, columns));
    x += f.n;
    first += auxiliaries(f);
  }
  return total;
}

std::optional<ExactProgram> pointwise_max(std::span<const ExactProgram> terms) {
  const std::size_t n = terms.front().n;
  std::size_t columns = n + 1;
  for (const ExactProgram& f : terms) columns += auxiliaries(f);
  ExactProgram highest(n, columns - n);
  for (std::size_t i = 0; i < n; ++i) highest.H[i] = terms.front().H[i];
  highest.c[n] = Fraction{1};
  std::size_t first = n + 1;
  for (const ExactProgram& f : terms) {
    for (std::size_t i = 0; i < f.variables(); ++i)
      if (i < n ? f.H[i] != terms.front().H[i] : !f.H[i].empty()) return std::nullopt;
    ExactProgram rows = substitute(f, placed_at(f, identity_maps(n), first), n, columns);
    ExactRow level{{n, Fraction{1}}};  // level >= c·ξ + constant
    for (std::size_t j = 0; j < columns; ++j) add(level, j, -rows.c[j]);
    highest.bound(std::move(level), rows.constant);
    highest.rows.insert(highest.rows.end(), rows.rows.begin(), rows.rows.end());
    first += auxiliaries(f);
  }
  return highest;
}

ExactProgram envelope(const ExactProgram& f, const Fraction& gamma, const ExactGram& W) {
  const std::size_t n = f.n, columns = 2 * n + auxiliaries(f);
  return add_joint(substitute(f, placed_at(f, identity_maps(n, n), 2 * n), n, columns),
                   half_square_of(W, Fraction{1} / gamma, along(n, Fraction{1}, Fraction{-1}), n, columns));
}

ExactProgram proximal_average(const ExactProgram& f, const ExactProgram& g, const Fraction& weight,
                              const Fraction& gamma, const ExactGram& W) {
  const Fraction rest = Fraction{1} - weight;
  if (sign(rest) == 0) return f;
  if (sign(weight) == 0) return g;
  const std::size_t n = f.n, columns = 2 * n + auxiliaries(f) + auxiliaries(g);
  const auto part = [&](const ExactProgram& h, const Fraction& of_d, const Fraction& factor,
                        std::size_t first) {
    return scale(substitute(h, placed_at(h, along(n, Fraction{1}, of_d), first), n, columns), factor);
  };
  return add_joint(add_joint(part(f, rest, weight, 2 * n), part(g, -weight, rest, 2 * n + auxiliaries(f))),
                   half_square_of(W, weight * rest / gamma, along(n, Fraction{0}, Fraction{1}), n, columns));
}

std::optional<ExactProgram> epigraph(const ExactProgram& f) {
  if (!f.is_polyhedral()) return std::nullopt;
  const std::size_t n = f.n + 1;
  ExactProgram made = substitute(f, placed_at(f, identity_maps(f.n), n), n, f.variables() + 1);
  ExactRow level{{f.n, Fraction{1}}};
  for (std::size_t j = 0; j < made.variables(); ++j) add(level, j, -made.c[j]);
  made.bound(std::move(level), made.constant);
  made.c.assign(made.variables(), Fraction{});
  made.constant = {};
  return made;
}

std::optional<ExactProgram> perspective(const ExactProgram& f) {
  if (!f.is_polyhedral()) return std::nullopt;
  const std::size_t n = f.n + 1;
  ExactProgram made = substitute(f, placed_at(f, identity_maps(f.n), n), n, f.variables() + 1);
  made.c[f.n] = made.constant;
  made.constant = {};
  for (ExactBound& bound : made.rows) {
    add(bound.row, f.n, -bound.limit);
    bound.limit = {};
  }
  made.bound({{f.n, Fraction{1}}}, {});
  return made;
}

ExactProgram conjugate(const ExactProgram& f) {
  // Only the variables in which H is not 0 need an entry of eta.
  const std::size_t n = f.n, m = f.rows.size();
  std::vector<std::size_t> place(f.variables());
  std::size_t columns = n + m;
  for (std::size_t j = 0; j < f.variables(); ++j)
    if (!f.H[j].empty()) place[j] = columns++;
  ExactProgram dual(n, columns - n);
  dual.constant = -f.constant;
  std::vector<ExactRow> equations(f.variables());  // v_i + (Gᵀlambda)_i - (H eta)_i = c_i
  for (std::size_t i = 0; i < f.variables(); ++i) {
    if (i < n) equations[i][i] = Fraction{1};
    for (const auto& [j, value] : f.H[i]) {
      add(equations[i], place[j], -value);
      add(dual.H[place[i]], place[j], value);
    }
  }
  for (std::size_t a = 0; a < m; ++a) {
    dual.c[n + a] = -f.rows[a].limit;
    for (const auto& [j, value] : f.rows[a].row) add(equations[j], n + a, value);
    if (!f.rows[a].two_sided) dual.bound({{n + a, Fraction{1}}}, {});
  }
  for (std::size_t i = 0; i < f.variables(); ++i) dual.equation(std::move(equations[i]), f.c[i]);
  return dual;
}

ExactProgram conjugate(const ExactProgram& f, const ExactGram& W) {
  return precompose(conjugate(f), W.rows, Fractions(f.n), f.n);
}

}  // namespace convex::inline exact_programs
