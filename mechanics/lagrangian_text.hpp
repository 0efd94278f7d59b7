#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "convex/invalid_input.hpp"

namespace mechanics {

/// Where a text begins in its file, and where it goes on behind each escape: the character at `offset` of the
/// text, and all behind it up to the next such place.
struct TextOrigin : convex::Place {
  struct Jump {
    std::size_t offset = 0;
    convex::Place place;
  };
  std::vector<Jump> jumps = {};

  TextOrigin(convex::Place begin = {}) : convex::Place(begin) {}
  TextOrigin(int at_line, int at_column) : convex::Place{at_line, at_column} {}
};

/// A piece of text and where it begins, so that an error can point into it.
struct Text {
  std::string text;
  TextOrigin begin;

  /// The place of the character at `offset`; lines are counted.
  convex::Place at(std::size_t offset) const;
};

/// `name` = `value`; the name may be that of a member, "x[3]", or of a family, "x[i]", "x[i in 2..3]".
struct NamedText {
  Text name;
  Text value;
  std::string told_as = {};  ///< how messages call the value, and no list the name; "": the name tells
};

/// The points of a table, as numbers and as they are written.
struct TablePoints {
  std::vector<double> x, y;
  std::vector<std::string> x_text, y_text;
};

/// Reads the file that table(x, "F.csv") names; InvalidInput says what is wrong with it.
using TableFile = std::function<TablePoints(const std::string& file)>;

/// The Lagrangian data of a system as text (docs/problem-files.md): T, V, Q, the constraints and what they
/// use.
struct LagrangianText {
  std::vector<Text> coordinates;
  Text kinetic;
  std::optional<Text> potential;
  std::vector<NamedText> parameters, definitions, forces, constraints;
  TableFile table_file = {};  ///< none: a table in a file is an error
};

/// A state as text: expressions in parameters and t. What is missing in `velocity` is 0.
struct StateText {
  std::optional<Text> t;
  std::optional<Text> position_table;  ///< where the positions are given, for the error when one is missing
  std::vector<NamedText> position, velocity;
};

}  // namespace mechanics
