#pragma once

#include <random>
#include <string>
#include <vector>

#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/metric.hpp"

namespace samples {

using convex::Index;

struct Named {
  std::string name;
  convex::LinearQuadratic f;
};

/// Every function and set of the room on n entries, with integer data.
std::vector<Named> catalogue(Index n);

/// Q diag(1 … condition) Qᵀ with a random orthogonal Q.
convex::Metric random_metric(std::mt19937& generator, Index n, double condition);

/// Multiples of 1/2 times `scale`, with ties and zeros.
convex::Vector tied_point(std::mt19937& generator, Index n, double scale);

}  // namespace samples
