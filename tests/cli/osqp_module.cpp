#include <doctest/doctest.h>

#include "cli/measurement/peer_module/peer_program.hpp"
#include "convex/loaded_module.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"

using namespace convex;

namespace {

struct SaidByPeer {
  int outcome = peer_failed;
  Vector q;
  double own_tolerance = 0;
};

/// By the module of OSQP, loaded as the program loads it, built on the stand-in of tests/oracles.
SaidByPeer by_osqp_module(const NearestPointProblem& problem, double tolerance) {
  static const LoadedModule module = load_symbol(MOREAU_OSQP_MODULE, MOREAU_OSQP_MODULE, "moreau_peer");
  REQUIRE_MESSAGE(module.symbol != nullptr, module.reason);
  const Index n = problem.dimension(), m = problem.rows();
  const Matrix A = problem.A.dense_gram();
  RowMatrix U(m, n);
  for (Index a = 0; a < m; ++a) U.row(a) = problem.U.row(a);
  std::vector<unsigned char> two_sided(static_cast<std::size_t>(m), 0);
  for (const Index a : problem.two_sided) two_sided[static_cast<std::size_t>(a)] = 1;
  SaidByPeer said;
  said.q = Vector::Zero(n);
  PeerProgram program{static_cast<int>(n), static_cast<int>(m), A.data(),  problem.z.data(), U.data(),
                      problem.s.data(),    two_sided.data(),    tolerance, said.q.data(),    0};
  said.outcome = reinterpret_cast<SolvePeer>(module.symbol)(&program);
  said.own_tolerance = program.own_tolerance;
  return said;
}

NearestPointProblem small_program() {
  Matrix A(3, 3), U(3, 3);
  A << 4, 1, 0.5, 1, 3, -1, 0.5, -1, 2;
  U << 1, 0, 0, 0, 1, 1, 1, -1, 2;
  return {Metric::dense(A),
          Vector{{-3.0, 1.0, -2.0}},
          ConstraintRows(RowMatrix(U)),
          Vector{{0.0, 0.5, 0.25}},
          {1}};
}

}  // namespace

TEST_CASE("the module of OSQP hands over half of A by columns, rows with bounds, and equalities as such") {
  const NearestPointProblem problem = small_program();
  const Vector truth = active_set(problem).q;
  // Something of each kind holds: a one-sided row, the equality, and a free direction.
  REQUIRE(std::abs(problem.U.row(1).dot(truth) - 0.5) < 1e-12);
  const SaidByPeer tight = by_osqp_module(problem, 1e-10);
  CHECK(tight.outcome == peer_solved);
  CHECK((tight.q - truth).norm() <= 1e-8);
  const SaidByPeer own = by_osqp_module(problem, 0);
  CHECK(own.outcome == peer_solved);
  CHECK((own.q - truth).norm() <= 1e-2);
  CHECK(own.own_tolerance == 1e-3);
}

TEST_CASE(
    "the module of OSQP says of a contradiction that it is one, and of what is refused that it failed") {
  NearestPointProblem problem = small_program();
  problem.U = ConstraintRows(RowMatrix{{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}});
  problem.s = Vector{{1.0, 0.0}};
  problem.two_sided = {};
  CHECK(by_osqp_module(problem, 1e-8).outcome == peer_infeasible);
}
