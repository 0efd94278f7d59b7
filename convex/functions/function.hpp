#pragma once

// `Function` by the name that it had in release 0.1.
#include "convex/gamma0/function.hpp"
