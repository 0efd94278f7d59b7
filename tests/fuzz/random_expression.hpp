#pragma once

#include <cstdint>
#include <random>
#include <string>

namespace fuzz {

/// A question as it is asked on the command line: an expression of the function language, a point and the
/// rows of a metric ("" for the plain one). `n` is the number of entries.
struct Question {
  std::string f, z, metric;
  int n = 1;
};

/// Question number `index` of a seed: functions, sets and operations of the catalogue, nested to depth 3; one
/// entry to four; points with ties, on breaks, tiny, huge and spread; metrics plain, diagonal and dense.
Question random_question(std::uint64_t seed, std::uint64_t index);

}  // namespace fuzz
