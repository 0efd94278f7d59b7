#include <doctest/doctest.h>

#include <random>

#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/proved_prox/pair_of_call.hpp"
#include "convex/proved_prox/proved_split.hpp"

using namespace convex;

TEST_CASE("a matrix that rounding would call semidefinite is told apart in fractions") {
  std::vector<ExactRow> Q = {{{0, Fraction{1}}, {1, Fraction{1}}}, {{0, Fraction{1}}, {1, Fraction{1}}}};
  CHECK(exact_programs::is_semidefinite(Q));
  Q[1][1] = read_fraction("999999999999999999999/1000000000000000000000").value();
  CHECK_FALSE(exact_programs::is_semidefinite(Q));
}

TEST_CASE(
    "a full Gram matrix of fewer vectors than rows is semidefinite, and not when any entry of its diagonal "
    "falls") {
  std::mt19937_64 generator(4);
  std::uniform_int_distribution<int> digit(-9, 9);
  const std::size_t n = 12, rank = 5;
  std::vector<Fractions> B(n, Fractions(rank));
  for (Fractions& row : B)
    for (Fraction& entry : row) entry = Fraction{digit(generator), 7};
  std::vector<ExactRow> Q(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) add(Q[i], j, dot(B[i], B[j]));
  CHECK(exact_programs::is_semidefinite(Q));
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<ExactRow> raised = Q, lowered = Q;
    add(raised[i], i, read_fraction("1e-40").value());
    add(lowered[i], i, read_fraction("-1e-40").value());
    CHECK(exact_programs::is_semidefinite(raised));
    CHECK_FALSE(exact_programs::is_semidefinite(lowered));
  }
}

TEST_CASE("programs in fractions have the values of the functions that they stand for, away from any prox") {
  for (const CatalogueEntry& entry : catalogue())
    for (const std::string_view example : entry.examples) {
      CAPTURE(example);
      const Call call = cli::parse_call(example, "f");
      const auto n = static_cast<std::size_t>(cli::number_of_entries(call));
      const ExactGram W = identity_gram(n);
      const auto program = exact_program(call, W);
      if (!program) continue;
      const Function f = make_function(call, {Metric::identity(static_cast<Index>(n))});
      for (int k = 0; k < 6; ++k) {
        Fractions x(n);
        for (std::size_t i = 0; i < n; ++i)
          x[i] = lowest_terms({(7 * k + 5 * static_cast<int>(i * i) + 3) % 9 - 3, k % 2 == 0 ? 4 : 2});
        const ExactValue exact = exact_value(*program, x);
        const double value = f(nearest(x));
        CHECK((exact.end == ProgramEnd::no_point) == std::isinf(value));
        if (exact.end == ProgramEnd::minimum)
          CHECK(std::abs(nearest_double(exact.value) - value) <= 1e-9 * (1 + std::abs(value)));
      }
    }
}
