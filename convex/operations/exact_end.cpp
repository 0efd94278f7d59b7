#include "convex/operations/exact_end.hpp"

#include <cmath>

#include "convex/exact_program/program_of_call.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline operations {
namespace {

/// A question of a function's making should cost no more than its proxes.
constexpr double part_of_operations = 0.01;

/// The program of f on n entries, where it has one that is quick to minimise.
std::optional<ExactProgram> quick_program(const Function& f, Index n, const ExactGram& plain) {
  auto program = exact_program(f.call(), plain);
  if (!program || program->n != static_cast<std::size_t>(n)) return std::nullopt;
  if (!(pair_operations(*program, plain) <= part_of_operations * most_word_operations)) return std::nullopt;
  return program;
}

}  // namespace

std::optional<ProgramEnd> exact_end(const Function& f, Index n) {
  const ExactGram plain = exact_gram(Metric::identity(n));
  const auto program = quick_program(f, n, plain);
  if (!program) return std::nullopt;
  return exact_prox(*program, plain, Fractions(static_cast<std::size_t>(n))).end;
}

std::optional<Value> exact_value_at(const Function& f, const Vector& x) {
  const auto program = quick_program(f, x.size(), exact_gram(Metric::identity(x.size())));
  if (!program) return std::nullopt;
  Fractions at;
  for (const double entry : x) at.push_back(fraction(entry));
  const ExactValue found = exact_value(*program, at);
  const double value = nearest_double(found.value);
  if (found.end != ProgramEnd::minimum || !std::isfinite(value)) return std::nullopt;
  return Value{value, unit_roundoff * std::abs(value)};
}

}  // namespace convex::inline operations
