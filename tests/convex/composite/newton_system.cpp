#include "convex/composite/newton_system.hpp"

#include <doctest/doctest.h>

#include "tests/convex/operations/samples.hpp"

using namespace convex;

TEST_CASE("a Newton step solves the linearised conditions, whether parts are thin or the matrix is full") {
  for (const Index n : {20, 100})
    for (const char* text : {"sum(norm2(3), indicator(box(-1, 2)))", "intersection(ball2(2), box(0, 2))",
                             "pointwise_max(squared_norm2(), norm1(2))"})
      for (const double theta : {1.0, 1e-4}) {
        CAPTURE(n);
        CAPTURE(text);
        CAPTURE(theta);
        const auto form = samples::function(text, n).node().graph(n, 1);
        REQUIRE(form);
        const SaddleProblem problem = saddle_problem(*form, 2 * samples::vector(n, 1), Metric::identity(n));
        const Vector t = 2 * samples::vector(problem.m, 2), r = samples::vector(problem.m, 3);
        const Vector rho = samples::vector(problem.n + problem.k, 4), ridge = 1e-3 * problem.R;
        const NewtonSystem system(problem, t, problem.D, theta, ridge);
        REQUIRE(system.usable());
        const NewtonStep step = system.step(rho, r);
        Vector row = problem.M * step.dxi + r, slopes = step.dy;
        for (const SaddleTerm& term : problem.terms) {
          const Vector d = problem.D.segment(term.first, term.rows);
          const Matrix J = term.f->prox_jacobian(t.segment(term.first, term.rows), d / term.scale);
          const Vector dt = step.dt.segment(term.first, term.rows), rest = dt - J * dt;
          row.segment(term.first, term.rows) -= J * dt + theta * rest;
          slopes.segment(term.first, term.rows) -= d.cwiseProduct(rest);
        }
        Vector balance = problem.G * step.dxi + problem.M.transpose() * step.dy + rho;
        balance.tail(problem.k) += ridge.cwiseProduct(step.dxi.tail(problem.k));
        const double size = 1e-9 * (rho.norm() + r.norm() + step.dy.norm() + step.dt.norm());
        CHECK(row.norm() <= size);
        CHECK(slopes.norm() <= size);
        CHECK(balance.norm() <= size);
      }
}
