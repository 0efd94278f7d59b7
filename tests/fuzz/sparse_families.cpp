#include "tests/fuzz/sparse_families.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tests/oracles/rational_elimination.hpp"

namespace fuzz {
using convex::ConstraintRows;
using convex::Index;
using convex::Metric;
using convex::NearestPointProblem;
using convex::SparseMatrix;
using convex::SparseRows;
using convex::Vector;
using oracles::Rational;
using oracles::RationalVector;

namespace {

using Row = std::map<Index, Rational>;

struct SparseDraft {
  Index n = 0;
  std::vector<Row> A;  ///< symmetric, rows of the whole
  RationalVector q;
  std::vector<Row> U;
  RationalVector s, lambda;
  std::vector<bool> two_sided;
  bool contradicts = false;

  Rational along(const Row& u) const {
    Rational sum = 0;
    for (const auto& [i, x] : u) sum += x * q[static_cast<std::size_t>(i)];
    return sum;
  }
  /// A row with u·q* - s = slack, and its multiplier.
  void add(Row u, const Rational& slack, const Rational& multiplier, bool both = false) {
    for (auto entry = u.begin(); entry != u.end();) entry = entry->second == 0 ? u.erase(entry) : ++entry;
    s.push_back(along(u) - slack);
    U.push_back(std::move(u));
    lambda.push_back(multiplier);
    two_sided.push_back(both);
  }
};

Rational power(int exponent) { return Rational(std::ldexp(1.0, exponent)); }

void couple(SparseDraft& draft, Index i, Index j, int by) {
  if (i == j) return;
  draft.A[static_cast<std::size_t>(i)][j] -= by;
  draft.A[static_cast<std::size_t>(j)][i] -= by;
  draft.A[static_cast<std::size_t>(i)][i] += by;
  draft.A[static_cast<std::size_t>(j)][j] += by;
}

SparseDraft coordinates(Random& random, Index n) {
  SparseDraft draft;
  draft.n = n;
  draft.A.resize(static_cast<std::size_t>(n));
  const bool at_rest = random.one_in(4);
  for (Index i = 0; i < n; ++i) {
    draft.A[static_cast<std::size_t>(i)][i] = random.between(1, 3);
    draft.q.emplace_back(at_rest ? 0 : random.between(-3, 3));
  }
  return draft;
}

/// Open, touched, or pressing.
void put(Random& random, SparseDraft& draft, Row u) {
  const int kind = random.below(8);
  const bool both = kind == 7;
  const Rational slack = kind < 2    ? Rational(random.between(1, 3))
                         : kind == 2 ? power(-random.between(10, 70))
                                     : Rational(0);
  const Rational multiplier = kind < 3 || kind == 3 ? Rational(0)
                              : kind == 4           ? power(-random.between(10, 60))
                                                    : Rational(random.between(1, 4));
  draft.add(std::move(u), slack, both ? multiplier * (random.one_in(2) ? 1 : -1) : multiplier, both);
}

/// Entries close to the diagonal.
SparseDraft banded(Random& random) {
  const Index n = random.between(40, 400);
  SparseDraft draft = coordinates(random, n);
  const int width = random.between(1, 3);
  for (Index i = 0; i < n; ++i)
    for (int k = 1; k <= width; ++k)
      if (i + k < n) couple(draft, i, i + k, random.between(0, 2));
  for (Index i = 0; i + 3 < n; ++i) {
    Row u;
    for (int k = 0; k < 4; ++k) u[i + k] = random.between(-2, 2);
    u[i + random.below(3)] = 1;
    if (!random.one_in(4)) put(random, draft, u);
  }
  return draft;
}

/// Differences along a tree, and bounds.
SparseDraft tree(Random& random) {
  const Index n = random.between(40, 400);
  SparseDraft draft = coordinates(random, n);
  const bool coupled = random.one_in(2);
  for (Index i = 1; i < n; ++i) {
    const Index parent = random.one_in(3) ? i - 1 : random.below(static_cast<int>(i));
    if (coupled) couple(draft, i, parent, random.between(0, 2));
    put(random, draft, {{i, 1}, {parent, -1}});
    if (random.one_in(4)) put(random, draft, {{i, random.one_in(2) ? 1 : -1}});
  }
  return draft;
}

/// Differences over a graph with many loops: redundant rows where all are two-sided.
SparseDraft graph(Random& random) {
  const Index n = random.between(40, 300);
  SparseDraft draft = coordinates(random, n);
  const bool coupled = random.one_in(2), all_held = random.one_in(3);
  for (Index k = 0; k < n + n / 2; ++k) {
    const Index i = random.below(static_cast<int>(n));
    const Index j = random.one_in(3) ? random.below(static_cast<int>(n)) : (i + random.between(1, 6)) % n;
    if (i == j) continue;
    if (coupled) couple(draft, i, j, random.between(0, 2));
    const Row u{{i, 1}, {j, -1}};
    if (all_held)
      draft.add(u, 0, random.between(-3, 3), true);
    else
      put(random, draft, u);
  }
  return draft;
}

/// A string of coordinates, each above the one before.
SparseDraft string(Random& random) {
  const Index n = random.between(40, 400);
  SparseDraft draft = coordinates(random, n);
  if (random.one_in(2)) draft.add({{0, 1}}, random.one_in(2) ? 0 : 1, 0);
  for (Index i = 1; i < n; ++i) {
    const int c = random.one_in(3) ? random.between(1, 3) : 1;
    const int kind = random.below(4);
    draft.add({{i, c}, {i - 1, -c}}, kind == 0 ? power(-random.between(0, 70)) : Rational(0),
              kind <= 1   ? Rational(0)
              : kind == 2 ? power(-random.between(0, 60))
                          : Rational(random.between(1, 3)));
  }
  return draft;
}

/// A string with some rows that fit into none.
SparseDraft bordered_string(Random& random) {
  SparseDraft draft = string(random);
  for (int k = random.between(1, 4); k > 0; --k) {
    Row u;
    for (int e = random.between(1, 4); e > 0; --e)
      u[random.below(static_cast<int>(draft.n))] = random.sign() * random.between(1, 2);
    put(random, draft, u);
  }
  return draft;
}

/// Bounds over a grid of points.
SparseDraft grid(Random& random) {
  const Index width = random.between(8, 20), height = random.between(8, 20);
  SparseDraft draft = coordinates(random, width * height);
  const int excess = random.between(0, 2);
  for (Index k = 0; k < draft.n; ++k) {
    auto& row = draft.A[static_cast<std::size_t>(k)];
    row.clear();
    row[k] = 4 + excess;
    if (k % width > 0) row[k - 1] = -1;
    if (k % width + 1 < width) row[k + 1] = -1;
    if (k >= width) row[k - width] = -1;
    if (k + width < draft.n) row[k + width] = -1;
    if (!random.one_in(3)) put(random, draft, {{k, 1}});
  }
  return draft;
}

/// A sum of rows close to each other becomes one more row, which a tiny number keeps from depending on them.
/// Its multiplier and theirs may be large and cancel but for that number.
void near_sum(Random& random, SparseDraft& draft, bool opposite) {
  const int m = static_cast<int>(draft.U.size());
  Row u;
  std::vector<std::pair<std::size_t, Rational>> terms;
  const int first = random.below(m), count = random.between(1, 3);
  const bool both = random.one_in(3);
  for (int k = 0; k < count; ++k) {
    const auto a = static_cast<std::size_t>((first + k * random.between(1, 2)) % m);
    const Rational c = random.between(1, 2) * (both && random.one_in(2) ? -1 : 1);
    terms.emplace_back(a, c);
    for (const auto& [i, x] : draft.U[a]) u[i] += (opposite ? -c : c) * x;
  }
  const int far = random.between(8, 50);
  const bool exactly = random.one_in(4);
  Index where = random.below(static_cast<int>(draft.n));
  if (!u.empty() && random.one_in(2))
    for (const auto& [i, x] : u)
      if (random.one_in(2)) where = i;
  if (!exactly) u[where] += power(-far) * random.sign();
  bool held = true;  // all on their edge
  for (const auto& [a, c] : terms) held = held && draft.s[a] == draft.along(draft.U[a]);
  const bool large = held && opposite && !exactly && random.one_in(2);
  const Rational multiplier =
      large ? power(std::min(far, 40)) * random.between(1, 2) : Rational(random.between(0, 2));
  if (large)
    for (const auto& [a, c] : terms) {
      if (c < 0 && !draft.two_sided[a]) return;
      draft.lambda[a] += multiplier * c;
    }
  const bool touched = random.one_in(2) || multiplier > 0;
  draft.add(u, touched || both ? Rational(0) : power(-random.between(10, 60)), multiplier, both);
}

/// Rows that add up to zero with bounds that do not, by a number as small as can be.
void contradict(Random& random, SparseDraft& draft) {
  const int m = static_cast<int>(draft.U.size());
  const int first = random.below(m), count = random.between(1, 4);
  Row u;
  Rational bound = 0;
  for (int k = 0; k < count; ++k) {
    const auto a = static_cast<std::size_t>((first + k) % m);
    for (const auto& [i, x] : draft.U[a]) u[i] -= x;
    bound -= draft.s[a];
  }
  for (auto entry = u.begin(); entry != u.end();) entry = entry->second == 0 ? u.erase(entry) : ++entry;
  if (u.empty()) return;
  const Rational gap = power(-random.between(0, 50));
  draft.add(u, 0, 0);
  draft.s.back() = bound + gap;
  draft.contradicts = true;
}

/// Rows told in units of their own, coordinates too: powers of two, nothing is rounded.
void change_units(Random& random, SparseDraft& draft) {
  for (std::size_t a = 0; a < draft.U.size(); ++a) {
    const Rational unit = power(random.between(-20, 20));
    for (auto& [i, x] : draft.U[a]) x *= unit;
    draft.s[a] *= unit;
    draft.lambda[a] /= unit;
  }
}

bool is_double(const Rational& x) { return Rational(x.get_d()) == x; }

struct Family {
  const char* name;
  SparseDraft (*draw)(Random&);
  int changes;  ///< 0: none; 1: near sums; 2: contradictions
};

constexpr std::array<Family, sparse_family_count> families{{{"bands", banded, 1},
                                                            {"trees", tree, 1},
                                                            {"graphs", graph, 1},
                                                            {"strings", string, 0},
                                                            {"strings with a border", bordered_string, 0},
                                                            {"grids", grid, 0},
                                                            {"contradictions on graphs", graph, 2},
                                                            {"contradictions on bands", banded, 2}}};

/// Empty when a number is no double.
bool finish(const SparseDraft& draft, PlantedSparse& planted) {
  const Index n = draft.n, m = static_cast<Index>(draft.U.size());
  RationalVector z(static_cast<std::size_t>(n));
  std::vector<Eigen::Triplet<double>> inertia, rows;
  bool diagonal = true;
  for (Index i = 0; i < n; ++i)
    for (const auto& [j, x] : draft.A[static_cast<std::size_t>(i)]) {
      z[static_cast<std::size_t>(i)] += x * draft.q[static_cast<std::size_t>(j)];
      diagonal = diagonal && (i == j || x == 0);
      if (x != 0) inertia.emplace_back(static_cast<int>(i), static_cast<int>(j), x.get_d());
    }
  planted.slack.resize(m);
  planted.lambda.resize(m);
  Vector s(m);
  std::vector<Index> two_sided;
  for (Index a = 0; a < m; ++a) {
    const auto k = static_cast<std::size_t>(a);
    for (const auto& [i, x] : draft.U[k]) {
      z[static_cast<std::size_t>(i)] -= x * draft.lambda[k];
      rows.emplace_back(static_cast<int>(a), static_cast<int>(i), x.get_d());
      if (!is_double(x)) return false;
    }
    if (!is_double(draft.s[k])) return false;
    s[a] = draft.s[k].get_d();
    planted.slack[a] = Rational(draft.along(draft.U[k]) - draft.s[k]).get_d();
    planted.lambda[a] = draft.lambda[k].get_d();
    if (draft.two_sided[k]) two_sided.push_back(a);
  }
  Vector force(n);
  for (Index i = 0; i < n; ++i) {
    if (!is_double(z[static_cast<std::size_t>(i)])) return false;
    force[i] = z[static_cast<std::size_t>(i)].get_d();
  }
  SparseRows U(m, n);
  U.setFromTriplets(rows.begin(), rows.end());
  SparseMatrix W(n, n);
  W.setFromTriplets(inertia.begin(), inertia.end());
  planted.problem = {diagonal ? Metric::diagonal(Vector(W.diagonal())) : Metric::sparse(W), std::move(force),
                     ConstraintRows(std::move(U)), std::move(s), std::move(two_sided)};
  planted.q.resize(draft.contradicts ? 0 : n);
  for (Index i = 0; i < planted.q.size(); ++i) planted.q[i] = draft.q[static_cast<std::size_t>(i)].get_d();
  return true;
}

}  // namespace

const char* sparse_family(int family) { return families.at(static_cast<std::size_t>(family)).name; }

PlantedSparse draw_sparse(int family, Random& random) {
  const Family& drawn = families.at(static_cast<std::size_t>(family));
  PlantedSparse planted;
  while (true) {
    SparseDraft draft = drawn.draw(random);
    if (drawn.changes > 0)
      for (int k = random.between(0, 6); k > 0; --k) near_sum(random, draft, random.one_in(2));
    if (drawn.changes == 2) contradict(random, draft);
    if (drawn.changes > 0 && random.one_in(3)) change_units(random, draft);
    if (finish(draft, planted)) return planted;
  }
}

}  // namespace fuzz
