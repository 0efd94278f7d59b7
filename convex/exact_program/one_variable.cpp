#include <cmath>

#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/invalid_input.hpp"
#include "convex/symbolic/function_of_call.hpp"

namespace convex::inline exact_programs {
namespace {

/// Symbols take numbers as the simplest fractions that round to them: those that are meant, here.
bool is_meant(double value, const std::string* written) {
  if (!std::isfinite(value)) return true;
  const auto exact = written != nullptr ? read_fraction(*written) : std::optional(fraction(value));
  return exact && *exact == symbolic::simplest_fraction(value);
}

bool reads_simply(const Call& call) {
  for (const NamedArgument& argument : call.arguments) {
    if (const auto* part = std::get_if<std::shared_ptr<const Call>>(&argument.value)) {
      if (!reads_simply(**part)) return false;
      continue;
    }
    RowMatrix numbers;
    if (const auto* number = std::get_if<double>(&argument.value))
      numbers = RowMatrix::Constant(1, 1, *number);
    else if (const auto* vector = std::get_if<Vector>(&argument.value))
      numbers = vector->transpose();
    else
      numbers = std::get<Matrix>(argument.value);
    const bool is_written = argument.written.size() == static_cast<std::size_t>(numbers.size());
    for (Index k = 0; k < numbers.size(); ++k)
      if (!is_meant(numbers.data()[k], is_written ? &argument.written[static_cast<std::size_t>(k)] : nullptr))
        return false;
  }
  return true;
}

std::optional<Fraction> end_of(const std::optional<symbolic::Surd>& end) { return rational(end); }

}  // namespace

std::optional<ExactProgram> of_one_variable(const Call& call, const ExactGram& W) {
  if (W.dimension() != 1) return std::nullopt;
  const ExactArguments a(call, 1);
  if (call.name == "distance") {
    const auto set = exact_program(a.call("set"), W), size = exact_program({"norm1"}, W);
    const Fraction weight = a.number("weight");
    if (!set || !size || sign(weight) <= 0) return std::nullopt;
    return inf_convolution(*set, scale(*size, weight));
  }
  if (call.name != "pointwise_max" || !reads_simply(call)) return std::nullopt;
  try {
    const auto made = symbolic::function_of(call, W.rows[0].at(0));
    const auto* curve = std::get_if<symbolic::ExactCurve>(&made);
    if (curve == nullptr) return std::nullopt;
    std::vector<ExactPiece> own;
    for (const symbolic::ExactPiece& piece : symbolic::pieces(*curve))
      own.push_back({end_of(piece.low), end_of(piece.high), symbolic::rational(piece.c2),
                     symbolic::rational(piece.c1), symbolic::rational(piece.c0)});
    return of_pieces(1, own);
  } catch (const InvalidInput&) {  // a part has no symbols, or pieces cross at roots
    return std::nullopt;
  }
}

}  // namespace convex::inline exact_programs
