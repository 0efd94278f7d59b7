#include "families.hpp"

#include <cmath>
#include <utility>

#include "random_data.hpp"

namespace speed {
namespace {

/// z and s such that q is the answer with these multipliers, and rows without one are `clearance` away.
DenseProblem around(Matrix A, RowMatrix U, Vector q, const Vector& lambda, const Vector& clearance) {
  Vector z = A * q - U.transpose() * lambda, s = U * q - clearance;
  return {std::move(A), std::move(U), std::move(z), std::move(s), std::move(q)};
}

/// `held` rows at random hold, the others are clear of theirs.
DenseProblem around_random_rows(RandomData& random, Matrix A, RowMatrix U, Index held) {
  Vector lambda = Vector::Zero(U.rows()), clearance = lambda;
  Index taken = 0;
  for (const Index a : random.shuffled(U.rows()))
    (taken++ < held ? lambda : clearance)[a] = random.uniform(0.1, 1.1);
  Vector q = random.normals(A.rows());
  return around(std::move(A), std::move(U), std::move(q), lambda, clearance);
}

DenseProblem plain(Index n, Index m, unsigned seed) {
  RandomData random(100 * static_cast<unsigned>(n) + seed);
  Matrix A = random.positive_definite(n);
  return around_random_rows(random, std::move(A), random.unit_rows(m, n), m > n ? 2 * m / 5 : m / 2);
}

/// A body that rests on m points of a table: it can rise, and turn about two axes. The corners carry it.
DenseProblem table(Index m) {
  RandomData random(static_cast<unsigned>(m));
  RowMatrix U = RowMatrix::Ones(m, 3);
  for (Index a = 0; a < m; ++a)
    for (Index i = 1; i < 3; ++i)
      U(a, i) = a < 4 ? ((a >> (i - 1)) & 1 ? -1 : 1) : random.integer(-64, 64) / 64.0;
  const Matrix A = Vector{{10, 2, 3}}.asDiagonal();
  return {A, std::move(U), Vector{{-98.1, 3, -2}}, Vector::Zero(m), Vector::Zero(3)};
}

/// Rows of rank n/2: as many independent ones, the rest copies, and sums of two or three with signs; of all,
/// a third is clear, a third weighs. Each third problem is pushed off its planted answer.
DenseProblem redundant(Index n, Index m, unsigned seed) {
  RandomData random(static_cast<unsigned>(1000 * n + m) + seed);
  const Index rank = n / 2;
  RowMatrix U = RowMatrix::Zero(m, n);
  const auto any = [&](Index count) { return random.integer(0, static_cast<int>(count) - 1); };
  for (Index a = 0; a < m; ++a) {
    const int terms = random.integer(1, 3);
    if (a < rank)
      U.row(a) = random.dyadic_row(n);
    else if (terms == 1)
      U.row(a) = U.row(any(a));
    else
      for (int k = 0; k < terms; ++k) U.row(a) += (any(4) == 0 ? -1 : 1) * U.row(any(rank));
  }
  Vector lambda = Vector::Zero(m), clearance = lambda;
  for (Index a = 0; a < m; ++a)
    if (const int lot = random.integer(0, 2); lot == 0)
      clearance[a] = random.integer(1, 16) / 16.0;
    else if (lot == 1)
      lambda[a] = random.uniform(0, 1);
  Matrix A = random.positive_definite(n);
  Vector q = random.dyadic_point(n);
  DenseProblem problem = around(std::move(A), std::move(U), std::move(q), lambda, clearance);
  if (seed % 3 == 2) {
    problem.z += 0.3 * random.normals(n);
    problem.planted.resize(0);
  }
  return problem;
}

/// `strong` rows weigh, `weak` others hold at the answer and do not. Dyadic: they touch exactly.
DenseProblem degenerate(Index n, Index m, Index strong, Index weak, unsigned seed) {
  RandomData random(static_cast<unsigned>(1000 * n + weak) + seed);
  RowMatrix U(m, n);
  Vector lambda = Vector::Zero(m), clearance = lambda;
  for (Index a = 0; a < m; ++a) {
    U.row(a) = random.dyadic_row(n);
    if (a < strong)
      lambda[a] = random.uniform(0.1, 1.1);
    else if (a >= strong + weak)
      clearance[a] = random.integer(2, 17) / 16.0;
  }
  Matrix A = random.positive_definite(n);
  Vector q = random.dyadic_point(n);
  return around(std::move(A), std::move(U), std::move(q), lambda, clearance);
}

/// Four pairs of rows at this angle from parallel (sign 1) or opposite (-1), all eight of them held.
DenseProblem near_parallel(double angle, double sign, unsigned seed) {
  RandomData random(4000 + seed);
  const Index n = 10;
  RowMatrix U = random.unit_rows(8, n);
  for (Index a = 0; a < 8; a += 2) {
    const Vector u = U.row(a), v = U.row(a + 1), across = (v - u.dot(v) * u).normalized();
    U.row(a + 1) = sign * std::cos(angle) * u + std::sin(angle) * across;
  }
  Matrix A = random.positive_definite(n);
  DenseProblem problem = around_random_rows(random, std::move(A), std::move(U), 8);
  problem.planted.resize(0);  // the rounding of z and s moves it by a unit in the last place over the angle
  return problem;
}

/// The last of 20 rows is minus the sum of the first six, and asks for `gap` more than they leave.
DenseProblem infeasible(double gap, unsigned seed) {
  RandomData random(6000 + seed);
  const Index n = 12, m = 20, clear = m - 7;
  RowMatrix U(m, n);
  for (Index a = 0; a + 1 < m; ++a) U.row(a) = random.dyadic_row(n);
  U.row(m - 1) = -U.topRows(6).colwise().sum();
  Vector s = U * random.dyadic_point(n);
  s.segment(6, clear).array() -= 2;
  s[m - 1] += gap;
  Matrix A = random.positive_definite(n);
  Vector z = random.normals(n);
  return {std::move(A), std::move(U), std::move(z), std::move(s)};
}

std::string size_of(Index n, Index m) { return "n" + std::to_string(n) + " m" + std::to_string(m); }

}  // namespace

std::vector<Family> families() {
  std::vector<Family> all;
  for (const auto& [n, m] :
       {std::pair<Index, Index>{6, 4}, {12, 10}, {30, 30}, {60, 120}, {100, 200}, {200, 400}}) {
    const auto make = [n = n, m = m](unsigned seed) { return plain(n, m, seed); };
    all.push_back({"dense " + size_of(n, m), Asked::cold, true, n, 3, make});
    all.push_back({"warm dense " + size_of(n, m), Asked::warm, true, n, n < 100 ? 3 : 1, make, true});
  }
  for (const Index m : {8, 64, 512})
    all.push_back(
        {"table m" + std::to_string(m), Asked::cold, true, 3, 1, [m](unsigned) { return table(m); }});
  for (const auto& [n, m] : {std::pair<Index, Index>{20, 40}, {20, 80}, {60, 120}, {60, 240}, {120, 480}})
    all.push_back({"redundant " + size_of(n, m), Asked::cold, true, n, 3,
                   [n = n, m = m](unsigned seed) { return redundant(n, m, seed); }});
  struct Vertex {
    Index n, m, strong, weak;
  };
  for (const Vertex& v : {Vertex{12, 16, 3, 3}, Vertex{12, 24, 6, 12}, Vertex{30, 60, 8, 16},
                          Vertex{30, 90, 15, 45}, Vertex{60, 180, 30, 90}, Vertex{100, 300, 40, 120}}) {
    const auto make = [v](unsigned seed) { return degenerate(v.n, v.m, v.strong, v.weak, seed); };
    all.push_back({"degenerate " + size_of(v.n, v.m), Asked::cold, true, v.n, 3, make});
    if (v.n == 60) all.push_back({"warm degenerate " + size_of(v.n, v.m), Asked::warm, true, v.n, 2, make});
  }
  for (const char* angle : {"1e-4", "1e-6", "1e-8"})
    for (const double sign : {1.0, -1.0})
      all.push_back(
          {(sign > 0 ? "parallel " : "opposite ") + std::string(angle), Asked::cold, true, 10, 3,
           [radians = std::stod(angle), sign](unsigned seed) { return near_parallel(radians, sign, seed); }});
  for (const auto& [name, gap] : {std::pair{"1", 1.0}, {"1e-3", 0x1p-10}, {"1e-6", 0x1p-20}})
    all.push_back({"infeasible gap " + std::string(name), Asked::cold, false, 12, 3,
                   [gap = gap](unsigned seed) { return infeasible(gap, seed); }});
  return all;
}

std::vector<DenseProblem> moved(const DenseProblem& problem, bool move_bounds) {
  RandomData random(77);
  std::vector<DenseProblem> points(8, problem);
  const double step = 0.01 * problem.z.norm() / std::sqrt(static_cast<double>(problem.z.size()));
  for (DenseProblem& point : points) {
    point.planted.resize(0);
    point.z += step * random.normals(point.z.size());
    if (move_bounds) point.s -= 0.01 * random.normals(point.s.size()).cwiseAbs();
  }
  return points;
}

}  // namespace speed
