#include <doctest/doctest.h>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

/// Functions of Ax + b whose A is nearly singular.
using convex::Decomposition;
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::Vector;
using samples::function;

TEST_CASE("the prox of a curved function of Ax + b keeps eleven digits where A is nearly singular") {
  struct Case {
    const char* f;
    Vector z;
    Matrix W;
    Vector x;  // of the optimality conditions, by Newton's method in sixty digits
  };
  const Matrix plane = Matrix::Identity(2, 2), space = Matrix::Identity(3, 3);
  for (const auto& [text, z, W, x] :
       {Case{"precompose(ball2(2,[-4,-3.654,0.312]),[[1000001,1000000,1000000],[1000000,1000001,1000000],"
             "[1000000,999999,1000001]],[1000001,1,1])",
             Vector{{-1.125, 26.810843467766745, 1.875}}, space,
             Vector{{-749999.453541395707343, 249998.335026366357313, 500000.868511110360048}}},
        {"precompose(power(10),[[1000000.5,1000000],[1000000,1000002]],[-1000000,1000001])", Vector{{3, 3}},
         plane, Vector{{799998.14403724259776211, -799997.54403973456748069}}},
        {"precompose(ball2(0.875,[-2.1758816338523337,2]),[[100001,100000],[100000,100001]],"
         "[-100000,-100000])",
         Vector{{-2, -2.006}}, Matrix{{9, -2}, {-2, 6}},
         Vector{{-0.9692253231046664746, 1.9692194436909476801}}},
        {"precompose(ball2(1.875,[-1.5,1.125]),[[1000002,1000000],[1000000,1000000.5]],[0,0])",
         Vector{{0.25, -0.09698298151435716}}, Matrix{{10, 9}, {9, 19}},
         Vector{{0.01066013268066426767897, -0.01066032817461095600250}}},
        {"precompose(norm2(1),[[10000.5,10000],[10000,10002]],[1,1])", Vector{{-2.646, 4}}, plane,
         Vector{{-2.439252474721901512047, 2.438969562242328937209}}},
        {"precompose(binary_entropy(),[[100001,100000],[100000,100003]],[100001,100000])",
         Vector{{-3, 1.365}}, plane, Vector{{-1.094349969342783552826, 0.09435402577032825989502}}},
        {"precompose(nuclear_norm(1.208,rows=2),[[10001,10000],[10000,10000.5]],[1,-4])", Vector{{-4, 0}},
         Matrix{{9, -6}, {-6, 6}}, Vector{{-2.269582466229487553126, 2.269789187505545314271}}}}) {
    CAPTURE(text);
    const Metric metric = Metric::dense(W);
    const Decomposition split = convex::decompose(function(text, z.size()), z, metric);
    const double error = metric.norm(split.x.x - x);
    CHECK(error <= split.x.error_bound);
    CHECK(error <= 1e-11 * metric.norm(x));
  }
}

TEST_CASE(
    "a polyhedron of Ax + b is met in the rows as given, where doubles do not hold their products with A") {
  struct Case {
    const char* f;
    Vector z;
    Matrix W;
    Vector x;  // the vertex, in fractions
  };
  for (const auto& [text, z, W, x] :
       {Case{"precompose(simplex(2),[[1.0000001999999998947288304407265968620777130126953125,1],"
             "[1,1.0000001000000000583867176828789524734020233154296875]],[10000000,0])",
             Vector{{3, -1.462}}, Matrix{{105, 0}, {0, 105}},
             Vector{{-33333327782986.865627, 33333324449654.418715}}},
        {"precompose(polyhedron([[-1,1],[-0.375,0.959],[1.75,-3]],[1.25,0,1.498]),"
         "[[10000002,10000000],[10000000,10000001]],[10000000,1])",
         Vector{{-4, -1}}, Matrix{{6, 3}, {3, 3}}, Vector{{-3333332.5840244650818, 3333332.250691241549}}}}) {
    CAPTURE(text);
    const Metric metric = Metric::dense(W);
    const Decomposition split = convex::decompose(function(text, 2), z, metric);
    CHECK(metric.norm(split.x.x - x) <= split.x.error_bound);
    CHECK(split.x.error_bound <= 1e-12 * metric.norm(x));
  }
}
