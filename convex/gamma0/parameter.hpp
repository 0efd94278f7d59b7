#pragma once

#include <string>

#include "convex/vector.hpp"

/// What the makers of functions and sets ask of their numbers. Each throws InvalidInput
/// "maker(parameter): what is wrong; what to do".
namespace convex::inline gamma0 {

void require_finite(const char* maker, const char* parameter, double number);
void require_finite(const char* maker, const char* parameter, const Vector& numbers);
void require_finite(const char* maker, const char* parameter, const Matrix& numbers);
/// At least one entry, each finite.
void require_entries(const char* maker, const char* parameter, const Vector& numbers);
/// The same, and each >= 0.
void require_nonnegative(const char* maker, const char* parameter, const Vector& numbers);
/// Finite and >= 0.
void require_nonnegative(const char* maker, const char* parameter, double number);
/// Whether n entries stack a square matrix by columns.
void require_square(const std::string& maker, Index n);
/// Finite and > 0.
void require_positive(const char* maker, const char* parameter, double number);

}  // namespace convex::inline gamma0
