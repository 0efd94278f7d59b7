#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"

/// Options by their names, as keywords of Python give them.
namespace python {

/// The value, or InvalidInput that names the option and what it was.
template <class T>
T option(const pybind11::handle& value, const std::string& key) {
  try {
    return pybind11::cast<T>(value);
  } catch (const pybind11::cast_error&) {
    const auto type = pybind11::cast<std::string>(pybind11::type::handle_of(value).attr("__name__"));
    throw convex::InvalidInput(key + ": a " + type + " does not fit; see the docstring for what it takes");
  }
}

/// Where it is given and not None.
template <class T>
void take(std::optional<T>& into, const pybind11::dict& options, const char* key) {
  if (options.contains(key) && !options[key].is_none()) into = option<T>(options[key], key);
}
template <class T>
void take(T& into, const pybind11::dict& options, const char* key) {
  if (options.contains(key) && !options[key].is_none()) into = option<T>(options[key], key);
}

/// A finite number above 0, or InvalidInput.
inline double positive(const pybind11::handle& value, const std::string& key) {
  const auto number = option<double>(value, key);
  if (std::isfinite(number) && number > 0) return number;
  throw convex::InvalidInput(key + ": not a positive number; give one above 0");
}
template <class T>
void take_positive(T& into, const pybind11::dict& options, const char* key) {
  if (options.contains(key) && !options[key].is_none()) into = positive(options[key], key);
}

/// Throws InvalidInput for an option that there is not.
inline void require_options(const pybind11::dict& given, const std::vector<std::string>& known) {
  for (const auto& item : given) {
    const auto key = pybind11::cast<std::string>(item.first);
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw convex::InvalidInput("unknown option " + key + "; " +
                                 convex::suggestion(key, known, "see the docstring"));
  }
}

}  // namespace python
