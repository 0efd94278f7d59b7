#pragma once

#include <string>

#include "tests/fuzz/random_expression.hpp"

namespace fuzz {

enum class Verdict { right, wrong, refused, open, invalid };

/// What became of a question; `why` says what is wrong, or the words of the refusal.
struct Outcome {
  Verdict verdict = Verdict::right;
  std::string why;
};

/// Splits z and judges the answer where it is called solved. Wrong is:
/// - f(x) + g(y) - (x|y) that is not 0 to 1e-9 of its terms;
/// - f(x) that is not the value by definition (`call_value`), or above an upper bound of it;
/// - a point u with ½||u - z||² + f(u) below that at x: x is not the prox;
/// - a point u with (u|y) - f(u) above g(y): g(y) is not the supremum;
/// - for one entry, the value of the conjugate at another point beside a searched supremum, finite or not.
/// Refused is a status other than solved; open, a split that is solved beside a value of the conjugate, of
/// the eight that are asked for one entry, that says it is not known; invalid, an expression that the library
/// refuses as such.
Outcome outcome(const Question& question);

}  // namespace fuzz
