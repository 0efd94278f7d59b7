#include <CGAL/Gmpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>
#include <doctest/doctest.h>

#include "convex/nearest_point/proof/exact_method.hpp"
#include "tests/oracles/planted_problem.hpp"
#include "tests/oracles/rational_text.hpp"

using convex::Index;
using convex::NearestPointProblem;
using oracles::Difficulty;
using oracles::Rational;

namespace {

using Exact = CGAL::Gmpzf;
using Program = CGAL::Quadratic_program<double>;
using Answer = CGAL::Quadratic_program_solution<Exact>;

/// Doubles are what they stand for; CGAL solves in integers with exponents.
Program program(const NearestPointProblem& problem) {
  Program made(CGAL::LARGER, false, 0, false, 0);
  const convex::Matrix A = problem.A.dense_gram();
  for (Index i = 0; i < problem.dimension(); ++i) {
    for (Index j = 0; j <= i; ++j) made.set_d(static_cast<int>(i), static_cast<int>(j), A(i, j));
    made.set_c(static_cast<int>(i), -problem.z[i]);
  }
  for (Index a = 0; a < problem.rows(); ++a) {
    const convex::Vector u = problem.U.row(a);
    for (Index i = 0; i < u.size(); ++i) made.set_a(static_cast<int>(i), static_cast<int>(a), u[i]);
    made.set_b(static_cast<int>(a), problem.s[a]);
  }
  for (Index a : problem.two_sided) made.set_r(static_cast<int>(a), CGAL::EQUAL);
  return made;
}

Rational rational(const Exact& x) {
  Rational value{mpz_class(x.man())};
  if (x.exp() >= 0)
    mpq_mul_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(x.exp()));
  else
    mpq_div_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(-x.exp()));
  return value;
}

}  // namespace

TEST_CASE("the exact solution is that of CGAL's quadratic programs, fraction by fraction") {
  for (const Difficulty difficulty :
       {Difficulty::none, Difficulty::repeated_rows, Difficulty::sums_of_rows, Difficulty::at_rest,
        Difficulty::two_sided_rows, Difficulty::opposite_rows})
    for (unsigned seed = 0; seed < 12; ++seed) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(difficulty));
      NearestPointProblem problem = oracles::planted_problem(seed, 5, 8, difficulty).problem;
      // Every other time something else than the planted solution: without one, perhaps.
      if (seed % 2 == 1)
        for (Index a = 0; a < problem.rows(); ++a) problem.s[a] += 0.1 * static_cast<double>((a + seed) % 3);
      const Program posed = program(problem);
      Answer answer = CGAL::solve_quadratic_program(posed, Exact());
      REQUIRE(answer.solves_quadratic_program(posed));
      const convex::ExactSolution found =
          convex::exact_active_set(convex::exact_problem(problem), convex::likely_active_rows(problem));
      CHECK((found.status == convex::Status::infeasible) == answer.is_infeasible());
      if (answer.is_infeasible()) continue;
      std::size_t i = 0;
      for (auto value = answer.variable_values_begin(); value != answer.variable_values_end(); ++value, ++i) {
        const Rational expected = rational(value->numerator()) / rational(value->denominator());
        CHECK((oracles::rational(convex::entry(found.q, i)) == expected));
      }
    }
}
