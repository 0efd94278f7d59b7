#include "convex/linear_algebra/compiled_products.hpp"

#ifdef MOREAU_PRODUCTS
MOREAU_PRODUCTS(template)
#endif
