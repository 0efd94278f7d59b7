#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace cli::inline reports {

/// Names that LaTeX has a letter for.
inline bool is_greek(std::string_view name) {
  constexpr std::array<std::string_view, 32> letters{
      "alpha", "beta",  "gamma", "delta", "epsilon", "zeta",  "eta",   "theta",   "iota", "kappa", "lambda",
      "mu",    "nu",    "xi",    "pi",    "rho",     "sigma", "tau",   "upsilon", "phi",  "chi",   "psi",
      "omega", "Gamma", "Delta", "Theta", "Lambda",  "Xi",    "Sigma", "Phi",     "Psi",  "Omega"};
  return std::find(letters.begin(), letters.end(), name) != letters.end();
}

}  // namespace cli::inline reports
