#include <cmath>

#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/tables.hpp"

namespace cli::inline problem_files {
namespace {

using convex::InvalidInput;
using mechanics::Text;

Text drawn_number(const TomlValue& value, const std::string& where) {
  if (value.is_string()) return {value.text, value.content};
  if (value.is_number() && std::isfinite(value.number)) return {value.text, value.content};
  throw InvalidInput(where + ": neither an expression nor a finite number; write it in quotation marks",
                     value.place);
}

/// ["x", "y"].
void add_place(DrawnShape& shape, const TomlValue& value, const std::string& where) {
  if (value.kind != TomlValue::Kind::array || value.array.size() != 2)
    throw InvalidInput(where + ": no place in the plane; write two expressions, [\"x\", \"y\"]", value.place);
  for (const TomlValue& one : value.array) shape.numbers.push_back(drawn_number(one, where));
}

DrawnShape drawn_shape(DrawnShape::Kind kind, const TomlEntry& entry, const std::string& where) {
  DrawnShape shape{kind, {entry.key, entry.place}, {}};
  switch (kind) {
    case DrawnShape::Kind::point:
      add_place(shape, entry.value, where);
      break;
    case DrawnShape::Kind::segment:
      if (entry.value.kind != TomlValue::Kind::array || entry.value.array.size() != 2)
        throw InvalidInput(where + ": no segment; write its two ends, [[\"0\", \"0\"], [\"x\", \"y\"]]",
                           entry.value.place);
      for (const TomlValue& end : entry.value.array) add_place(shape, end, where);
      break;
    case DrawnShape::Kind::circle: {
      const TomlValue& circle = require_table(entry.value, where);
      require_known_keys(circle, where, {"centre", "radius"});
      const TomlValue *centre = circle.find("centre"), *radius = circle.find("radius");
      if (centre == nullptr || radius == nullptr)
        throw InvalidInput(where + (centre == nullptr ? ".centre" : ".radius") +
                               ": missing; write { centre = [\"x\", \"y\"], radius = \"r\" }",
                           entry.place);
      add_place(shape, *centre, where + ".centre");
      if (radius->is_number() && radius->number < 0)
        throw InvalidInput(where + ".radius: " + shown(radius->text) + " is negative; give a length",
                           radius->place);
      shape.numbers.push_back(drawn_number(*radius, where + ".radius"));
    }
  }
  return shape;
}

}  // namespace

std::vector<DrawnShape> read_draw(const TomlValue& table) {
  convex::Mistakes mistakes;
  mistakes.gather([&] {
    require_known_keys(require_table(table, "draw"), "draw", {"points", "segments", "circles"});
  });
  std::vector<DrawnShape> shapes;
  const auto add = [&](const char* key, DrawnShape::Kind kind) {
    const TomlValue* of_kind = table.find(key);
    if (of_kind == nullptr) return;
    const std::string where = std::string("draw.") + key;
    mistakes.gather([&] { require_table(*of_kind, where); });
    for (const TomlEntry& entry : of_kind->table)
      mistakes.gather([&] { shapes.push_back(drawn_shape(kind, entry, where + "." + shown(entry.key))); });
  };
  add("segments", DrawnShape::Kind::segment);
  add("circles", DrawnShape::Kind::circle);
  add("points", DrawnShape::Kind::point);
  mistakes.tell();
  return shapes;
}

}  // namespace cli::inline problem_files
