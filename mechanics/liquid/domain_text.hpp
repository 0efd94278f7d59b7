#pragma once

#include <map>
#include <string>
#include <vector>

#include "mechanics/lagrangian_text.hpp"

namespace mechanics::liquid {

/// name(key=value, …); a value is an expression or a list of lists, [[0, 0], [1, 0]].
struct ShapeText {
  struct Value {
    Text text;
    bool is_list = false;
    std::vector<Value> entries;
  };
  std::string name;
  std::map<std::string, Value> values;
};

/// Throws InvalidInput with the place.
ShapeText parse_shape(const Text&);

}  // namespace mechanics::liquid
