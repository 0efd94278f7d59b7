#include "tests/fuzz/edge_families.hpp"

#include <array>
#include <cmath>

namespace fuzz {
using convex::ConstraintRows;
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Vector;

std::uint64_t Random::bits() {
  std::uint64_t b = (state_ += 0x9E3779B97F4A7C15ULL);
  b = (b ^ (b >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  b = (b ^ (b >> 27U)) * 0x94D049BB133111EBULL;
  return b ^ (b >> 31U);
}

double Random::tiny() { return one_in(8) ? 0 : sign() * std::ldexp(1, -between(20, 52)); }

namespace {

struct Draft {
  Matrix A;
  RowMatrix U;
  Vector z, s;
  std::vector<Index> two_sided;
};

Matrix whole_metric(Random& random, Index n) {
  Matrix B(n, n);
  for (double& x : B.reshaped()) x = random.between(-2, 2);
  return B * B.transpose() + Matrix::Identity(n, n) * random.between(1, 3);
}

Vector whole(Random& random, Index n, int most) {
  Vector x(n);
  for (double& entry : x) entry = random.between(-most, most);
  return x;
}

/// Rows and bounds of small whole numbers; half of the bounds are those of one point.
Draft plain(Random& random, Index most_coordinates = 5, Index most_rows = 8) {
  const Index n = random.between(1, static_cast<int>(most_coordinates));
  const Index m = random.between(1, static_cast<int>(most_rows));
  Draft draft{whole_metric(random, n), RowMatrix(m, n), whole(random, n, 8), Vector(m), {}};
  for (double& x : draft.U.reshaped()) x = random.between(-2, 2);
  draft.s = draft.U * whole(random, n, 3);
  for (double& x : draft.s)
    if (random.one_in(2)) x -= random.between(0, 3);
  return draft;
}

/// One row becomes a sum of others, moved by a tiny number in an entry and in its bound.
void near_sum(Random& random, Draft& draft, double scale_of_first) {
  const Index m = draft.U.rows(), n = draft.U.cols();
  const Index p = random.below(static_cast<int>(m)), terms = random.between(1, 3);
  Vector row = Vector::Zero(n);
  double bound = 0;
  for (Index k = 0; k < terms; ++k) {
    const Index a = random.below(static_cast<int>(m));
    if (a == p) continue;
    const double c = k == 0 ? scale_of_first : random.sign() * random.between(1, 2);
    row += c * draft.U.row(a).transpose();
    bound += c * draft.s[a];
  }
  row[random.below(static_cast<int>(n))] += random.tiny();
  draft.U.row(p) = row;
  draft.s[p] = bound + (random.one_in(2) ? random.tiny() : 0);
}

Draft near_dependent_two_sided(Random& random) {
  Draft draft = plain(random);
  for (int k = random.between(1, 2); k > 0; --k)
    near_sum(random, draft, random.sign() * random.between(1, 2));
  for (Index a = 0; a < draft.U.rows(); ++a)
    if (!random.one_in(3)) draft.two_sided.push_back(a);
  return draft;
}

Draft opposite(Random& random) {
  Draft draft = plain(random);
  for (int k = random.between(1, 2); k > 0; --k) near_sum(random, draft, -1);
  return draft;
}

/// Pairs of rows a tiny angle from opposite, through one point or just past it.
Draft wedge(Random& random) {
  Draft draft = plain(random, 3, 6);
  const Index m = draft.U.rows(), n = draft.U.cols();
  for (Index a = 0; a + 1 < m; a += 2) {
    draft.U.row(a + 1) = -draft.U.row(a);
    for (Index i = 0; i < n; ++i) draft.U(a + 1, i) += random.tiny();
    draft.s[a + 1] = -draft.s[a] + random.tiny() + (random.one_in(3) ? -random.between(0, 1) : 0);
  }
  return draft;
}

/// More rows than coordinates through one point, each moved by a tiny number.
Draft moved_vertex(Random& random) {
  Draft draft = plain(random, 4, 8);
  const Vector vertex = whole(random, draft.U.cols(), 3);
  draft.s = draft.U * vertex;
  for (double& x : draft.s) x += random.one_in(2) ? random.tiny() : 0;
  draft.z = draft.A * vertex - draft.U.transpose() * whole(random, draft.U.rows(), 2).cwiseAbs();
  return draft;
}

Draft near_parallel(Random& random) {
  Draft draft = plain(random);
  for (int k = random.between(1, 3); k > 0; --k) near_sum(random, draft, 1);
  return draft;
}

/// Rows and coordinates told in units far apart.
Draft units(Random& random) {
  Draft draft = random.one_in(2) ? opposite(random) : moved_vertex(random);
  for (Index a = 0; a < draft.U.rows(); ++a) {
    const double unit = std::pow(10, random.between(-12, 12));
    draft.U.row(a) *= unit;
    draft.s[a] *= unit;
  }
  for (Index i = 0; i < draft.U.cols(); ++i) {
    const double unit = std::ldexp(1, random.between(-30, 30));
    draft.U.col(i) *= unit;
    draft.A.col(i) *= unit;
    draft.A.row(i) *= unit;
    draft.z[i] *= unit;
  }
  return draft;
}

Draft masses(Random& random) {
  Draft draft = random.one_in(2) ? plain(random) : moved_vertex(random);
  draft.A = Matrix::Zero(draft.A.rows(), draft.A.cols());
  for (Index i = 0; i < draft.A.rows(); ++i)
    draft.A(i, i) = std::ldexp(random.between(1, 3), random.between(-40, 40));
  return draft;
}

/// A nearly singular A of whole numbers.
Draft ill_conditioned(Random& random) {
  Draft draft = plain(random);
  const Index n = draft.A.rows();
  Matrix B(n, n);
  for (double& x : B.reshaped()) x = random.between(-3, 3);
  if (n > 1) B.row(n - 1) = B.row(0) * random.between(1, 2);
  draft.A = B * B.transpose() + Matrix::Identity(n, n) * std::ldexp(1, -random.between(10, 40));
  return draft;
}

/// Multipliers of 0 on rows that hold.
Draft weak(Random& random) {
  Draft draft = plain(random);
  const Vector q = whole(random, draft.U.cols(), 3);
  draft.s = draft.U * q;
  Vector lambda = whole(random, draft.U.rows(), 2).cwiseMax(0);
  draft.z = draft.A * q - draft.U.transpose() * lambda;
  if (random.one_in(2)) draft.z[0] += random.tiny();
  return draft;
}

/// Rows through one point that nearly depend on each other, in units of powers of two.
Draft touched(Random& random) {
  Draft draft = plain(random, 4, 6);
  for (int k = random.between(1, 3); k > 0; --k)
    near_sum(random, draft, random.sign() * random.between(1, 2));
  for (auto row : draft.U.rowwise())
    if (random.one_in(3)) row *= std::ldexp(1, random.between(-48, 24));
  const Vector q = whole(random, draft.U.cols(), 2);
  draft.s = draft.U * q;
  const Vector lambda = whole(random, draft.U.rows(), 2)
                            .cwiseMax(0)
                            .cwiseQuotient(draft.U.rowwise().lpNorm<1>().cwiseMax(0x1p-60));
  draft.z = draft.A * q - draft.U.transpose() * lambda;
  for (Index a = 0; a < draft.U.rows(); ++a)
    if (random.one_in(4)) draft.two_sided.push_back(a);
  return draft;
}

struct Family {
  const char* name;
  Draft (*draw)(Random&);
};

constexpr std::array<Family, edge_family_count> families{
    {{"near-dependent two-sided rows", near_dependent_two_sided},
     {"opposite rows", opposite},
     {"wedges", wedge},
     {"moved vertices", moved_vertex},
     {"near-parallel rows", near_parallel},
     {"units", units},
     {"masses", masses},
     {"ill-conditioned A", ill_conditioned},
     {"weak rows", weak},
     {"touched rows", touched}}};

}  // namespace

const char* edge_family(int family) { return families.at(static_cast<std::size_t>(family)).name; }

NearestPointProblem draw_edge(int family, Random& random) {
  Draft draft = families.at(static_cast<std::size_t>(family)).draw(random);
  return {Metric::dense(draft.A), std::move(draft.z), ConstraintRows(std::move(draft.U)), std::move(draft.s),
          std::move(draft.two_sided)};
}

}  // namespace fuzz
