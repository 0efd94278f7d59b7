#include "convex/exact_program/cgal_program.hpp"

#include <CGAL/Gmpz.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

#include "convex/invariant.hpp"

namespace convex::inline exact_programs {
namespace {

using Exact = CGAL::Gmpz;

Exact gmp(const Integer& a) { return Exact(a.text()); }

Integer integer(const Exact& a) { return a.mpz() == nullptr ? Integer(0) : Integer::from_gmp(a.mpz()); }

Fraction fraction_of(const CGAL::Quotient<Exact>& a) {
  const Integer p = integer(a.numerator()), q = integer(a.denominator());
  return lowest_terms(q.sign() < 0 ? Fraction{-p, -q} : Fraction{p, q});
}

/// A row times the product of its denominators' least common multiple.
Integer common_denominator(const ExactRow& row, const Fraction& limit) {
  Integer unit = limit.denominator;
  for (const auto& [j, value] : row)
    unit *= exact_quotient(value.denominator, greatest_common_divisor(value.denominator, unit));
  return unit;
}

Integer times(const Fraction& a, const Integer& unit) {
  return a.numerator * exact_quotient(unit, a.denominator);
}

}  // namespace

CgalAnswer cgal_minimum(const ExactProgram& f) {
  CGAL::Quadratic_program<Exact> program(CGAL::LARGER, false, 0, false, 0);
  Integer unit = 1;
  for (std::size_t i = 0; i < f.variables(); ++i) {
    const Integer own = common_denominator(f.H[i], lowest_terms(f.c[i]));
    unit *= exact_quotient(own, greatest_common_divisor(own, unit));
  }
  for (std::size_t i = 0; i < f.variables(); ++i) {
    const int at = static_cast<int>(i);
    program.set_c(at, gmp(times(lowest_terms(f.c[i]), unit)));
    for (const auto& [j, value] : f.H[i])
      if (j <= i) program.set_d(at, static_cast<int>(j), gmp(times(value, unit)));
  }
  std::vector<Integer> units;
  for (std::size_t a = 0; a < f.rows.size(); ++a) {
    const ExactBound& bound = f.rows[a];
    const Fraction limit = lowest_terms(bound.limit);
    units.push_back(common_denominator(bound.row, limit));
    const int at = static_cast<int>(a);
    for (const auto& [j, value] : bound.row)
      program.set_a(static_cast<int>(j), at, gmp(times(value, units.back())));
    program.set_b(at, gmp(times(limit, units.back())));
    program.set_r(at, bound.two_sided ? CGAL::EQUAL : CGAL::LARGER);
  }
  const auto found = CGAL::solve_quadratic_program(program, Exact());
  if (found.is_infeasible()) return {ProgramEnd::no_point, {}, {}};
  if (found.is_unbounded()) return {ProgramEnd::unbounded, {}, {}};
  CgalAnswer answer;
  for (auto value = found.variable_values_begin(); value != found.variable_values_end(); ++value)
    answer.xi.push_back(fraction_of(*value));
  std::size_t a = 0;
  for (auto value = found.optimality_certificate_begin(); value != found.optimality_certificate_end();
       ++value)
    answer.lambda.push_back(-fraction_of(*value) * Fraction{units[a++], unit});  // CGAL's have the other sign
  answer.xi.resize(f.variables());
  answer.lambda.resize(f.rows.size());
  return answer;
}

}  // namespace convex::inline exact_programs
