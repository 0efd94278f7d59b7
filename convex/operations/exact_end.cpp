#include "convex/operations/exact_end.hpp"

#include "convex/exact_program/program_of_call.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline operations {
namespace {

/// A question of a function's making should cost no more than its proxes.
constexpr double part_of_operations = 0.01;

}  // namespace

std::optional<ProgramEnd> exact_end(const Function& f, Index n) {
  const ExactGram plain = exact_gram(Metric::identity(n));
  const auto program = exact_program(f.call(), plain);
  if (!program || program->n != static_cast<std::size_t>(n)) return std::nullopt;
  if (!(pair_operations(*program, plain) <= part_of_operations * most_word_operations)) return std::nullopt;
  return exact_prox(*program, plain, Fractions(static_cast<std::size_t>(n))).end;
}

}  // namespace convex::inline operations
