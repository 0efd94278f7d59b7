#pragma once

#include "convex/gamma0/function.hpp"

/// Norms that favour vectors with at most k entries (Argyriou, Foygel and Srebro 2012). k = 1, 2, …; weight,
/// radius >= 0.
namespace convex::inline named_functions {

/// weight times the gauge of the convex hull of {|x|_2 <= 1, at most k entries not 0}: k = 1 is norm1, k = n
/// is norm2. The support function of largest_entries_ball(k, weight).
Function k_support(double k, double weight = 1);
/// {x : the root of the sum of the k largest squares is at most `radius`}.
Set largest_entries_ball(double k, double radius = 1);

/// weight (Σ |X_(i+1,j) - X_(i,j)| + |X_(i,j+1) - X_(i,j)|) of a matrix X of so many rows and n entries
/// stacked by columns (Rudin, Osher and Fatemi 1992, by coordinates).
Function total_variation_2d(double weight, Index rows, Index n);

}  // namespace convex::inline named_functions
