#pragma once

#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace convex::inline reductions {

/// Coordinates that A or a row of U couples belong to one island; the nearest point of the whole is made of
/// those of the islands. Islands are numbered by their first coordinate.
struct Islands {
  Index count = 0;
  std::vector<Index> of_coordinate;  ///< n
  std::vector<Index> of_row;         ///< m; -1 for a row of zeros
};

/// The connected components, in O(n + entries of A and U); for a dense A it ends as soon as all is connected,
/// which the first column tells as a rule. The data are checked.
Islands find_islands(const NearestPointProblem&);

/// The coordinates and rows of every island.
struct IslandLists {
  std::vector<std::vector<Index>> coordinates, rows;
};
IslandLists list_islands(const Islands&);

/// One island as a problem of its own, coordinates and rows in their order in the whole.
/// place: n, room for the positions of coordinates, kept between calls.
NearestPointProblem island_problem(const NearestPointProblem&, const std::vector<Index>& coordinates,
                                   const std::vector<Index>& rows, std::vector<Index>& place);

}  // namespace convex::inline reductions
