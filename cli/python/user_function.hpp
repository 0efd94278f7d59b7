#pragma once

#include "convex/gamma0/node.hpp"

namespace pybind11 {
class object;
}

namespace python {

/// A function that a user wrote in Python, by its value f(x) and its prox(z, W). Its prox is taken at its
/// word of a few roundings.
std::shared_ptr<const convex::FunctionNode> user_function(pybind11::object value, pybind11::object prox,
                                                          convex::Index n, std::string name);

}  // namespace python
