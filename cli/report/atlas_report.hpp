#pragma once

#include <string>
#include <vector>

#include "convex/atlas/dropping_rule.hpp"
#include "convex/atlas/plane_map.hpp"

namespace cli::inline reports {

/// `--over "force.x=-5:5"`: a force on one coordinate, added to that of the file.
struct ForceRange {
  std::string key;
  std::size_t coordinate = 0;
  convex::Fraction low, high;
};

/// Throws InvalidInput for what has not this form, or names no coordinate.
ForceRange parse_force_range(const std::string& text, const std::vector<std::string>& coordinates);

/// The atlas in the plane of one or two such forces.
struct AtlasMap {
  std::vector<ForceRange> over;
  std::vector<convex::atlas::PlaneRegion> regions;

  double area() const;
  /// Parts of the area on which the hypothesis that all contacts persist is right, on which the rule of
  /// dropping negative multipliers is, and on which it is wrong; none where the rule is not defined.
  struct RuleParts {
    double accepted = 0, right = 0, wrong = 0;
  };
  std::optional<RuleParts> rule(const convex::atlas::Atlas&) const;
};

/// An atlas with the names of a problem file, as its reports need it.
struct SolvedAtlas {
  std::string file, title;
  std::vector<std::string> coordinates;
  std::vector<std::string> contacts;  ///< names of the rows
  bool as_written = false;            ///< of the numbers as written; else of their doubles
  convex::ExactVector z;
  convex::atlas::Atlas atlas;
  std::string distribution = {};                               ///< of z, in words
  std::vector<convex::atlas::Probability> probabilities = {};  ///< one per cell
  double tolerance = 0;                                        ///< asked for, of each
  std::vector<std::size_t> here = {};                          ///< the cells that z lies in
  std::optional<convex::atlas::RuleVerdict> rule = {};         ///< where it is defined
  std::optional<AtlasMap> map = {};
  /// Without a cell: integers w, one a row, w >= 0 on one-sided ones, wᵀU = 0, w·s > 0.
  convex::IntegerVector farkas = {};
  convex::Vector rounded_farkas = {};  ///< the same in doubles

  /// The contacts that exclude each other: those with a weight.
  std::vector<std::size_t> culprits() const;
  /// The names of a cell's contacts.
  std::vector<std::string> names(const convex::atlas::Cell&) const;
  /// Of all cells; 1 within the sum of their bounds, for nothing is normalised.
  convex::atlas::Probability sum() const;
  bool is_accurate() const;
};

/// What lies behind a wall of the cell at z, and how far off it is: ||.||_(A⁻¹).
struct AtlasMargin {
  std::size_t cell = 0;
  double distance = 0;
  std::vector<std::size_t> closing, opening;  ///< contacts
};

/// By distance; of the first cell at z.
std::vector<AtlasMargin> margins(const SolvedAtlas&);

std::string atlas_json(const SolvedAtlas&);
std::string atlas_text(const SolvedAtlas&);

}  // namespace cli::inline reports
