#pragma once

#include <span>

#include "convex/exact_program/exact_gram.hpp"
#include "convex/exact_program/exact_program.hpp"

/// The algebra of piecewise linear-quadratic functions in fractions: the operations of
/// linear_quadratic/operations.hpp, which has the formulas and their sources, without rounding.
namespace convex::inline exact_programs {

ExactProgram sum(std::span<const ExactProgram> terms);
ExactProgram inf_convolution(const ExactProgram& f, const ExactProgram& g);
/// x -> f(Ax + b). A: one row for each variable of f, over `columns` entries.
ExactProgram precompose(const ExactProgram& f, const std::vector<ExactRow>& A, const Fractions& b,
                        std::size_t columns);
ExactProgram scale(ExactProgram f, const Fraction& alpha);
ExactProgram dilate(const ExactProgram& f, const Fraction& rho);
ExactProgram translate(const ExactProgram& f, const Fractions& by);
ExactProgram tilt(ExactProgram f, const Fractions& v);
ExactProgram separable(std::span<const ExactProgram> blocks);
/// Of polyhedral functions, or of ones that differ by polyhedral ones from the same quadratic of x; none
/// otherwise.
std::optional<ExactProgram> pointwise_max(std::span<const ExactProgram> terms);
ExactProgram envelope(const ExactProgram& f, const Fraction& gamma, const ExactGram& W);
ExactProgram proximal_average(const ExactProgram& f, const ExactProgram& g, const Fraction& weight,
                              const Fraction& gamma, const ExactGram& W);
/// {(x, t) : f(x) <= t} and (x, s) -> s f(x/s), closed, of a polyhedral f; none of others.
std::optional<ExactProgram> epigraph(const ExactProgram& f);
std::optional<ExactProgram> perspective(const ExactProgram& f);

/// f*(v) = sup_x v·x - f(x), the dual program.
ExactProgram conjugate(const ExactProgram& f);
/// The conjugate in the product of W: y -> f*(Wy).
ExactProgram conjugate(const ExactProgram& f, const ExactGram& W);

}  // namespace convex::inline exact_programs
