#include <doctest/doctest.h>

#include <cmath>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"

using convex::Function;
using convex::Metric;
using convex::Space;
using convex::Vector;

namespace {

/// prox of gamma f at z, as another library's tests or manual have it.
struct PeerProx {
  std::string source;
  std::string f;
  std::string gamma;  ///< a step, or one for each entry
  std::string z;
  std::string x;
  double tolerance;  ///< the digits that are in print, or rounding
};

const PeerProx peer_proxes[] = {
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "norm1(0.6)", "[0.4]",
     "[0.24488032099324117,0.6361148017053393,-0.7468003460445393,-0."
     "39461027607226284,-0.766936244339526,0."
     "08238242897650354,-1.4822688010626806,0.23915849610266143,-0."
     "5124773673251194,0.14222091048851146]",
     "[0.004880320993241177,0.3961148017053393,-0.5068003460445393,-0."
     "15461027607226285,-0.526936244339526,0,"
     "-1.2422688010626806,0,-0.2724773673251194,0]",
     1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "psd_cone()", "[1]",
     "[1,2,3,2,2,2,6,2.5,3,6,3,1.5,2,2.5,1.5,1]",
     "[1.641094719552072,2.377714502111725,2.528109000288716,1."
     "4927448378285653,2.377714502111725,3."
     "9278061374789126,4.252268313021482,1.97400141174866,2.528109000288716,4."
     "252268313021482,4."
     "614031336898144,2.069137895954736,1.4927448378285653,1.9740014117486595,"
     "2.069137895954736,1."
     "431611341727523]",
     1e-14},
    // packed there, off-diagonal entries times sqrt(2)
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "psd_cone()", "[1]",
     "[1,2,3,2,2,2,6,2.5,3,6,3,1.5,2,2.5,1.5,1]",
     "[1.641094719552072,2.377714502111725,2.528109000288716,1."
     "4927448378285653,2.377714502111725,3."
     "9278061374789126,4.252268313021482,1.97400141174866,2.528109000288716,4."
     "252268313021482,4."
     "614031336898144,2.069137895954736,1.4927448378285653,1.97400141174866,2."
     "069137895954736,1."
     "431611341727523]",
     1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "exponential_cone()", "[1]",
     "[0.5376671395461,1.833885014595086,-2.258846861003648]",
     "[-0.2331395211405815,0.2108704992310933,0.06980034791326437]", 1.5e-08},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "exponential_cone()", "[1]",
     "[-0.4335920223056836,0.3426244665386499,3.57839693972576]",
     "[-0.4335920223056836,0.3426244665386499,3.57839693972576]", 1.5e-08},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "exponential_cone()", "[1]",
     "[0.7647528861899316,-0.20198832835175584,0.9528202307304982]",
     "[0.30504984970236265,0.1688454299327435,1.0283026364773413]", 1.5e-08},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "orthant()", "[1]",
     "[0.7647528861899316,-0.20198832835175584,0]", "[0.7647528861899316,0,0]", 1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "box(-inf, 0)", "[1]",
     "[-0.7647528861899316,0.20198832835175584,0]", "[-0.7647528861899316,0,0]", 1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "point(0)", "[1]", "[-0.01,0]",
     "[0,0]", 1e-14},
    // the bound is the first entry there
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "second_order_cone()", "[1]",
     "[1,2]", "[1,2]", 1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "rotated_second_order_cone()",
     "[1]", "[1,1,1]", "[1,1,1]", 1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:docs/src/index.md", "norm1(3.5)", "[0.5]", "[1,2,3,4,5]",
     "[0,0.25,1.25,2.25,3.25]", 1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/"
     "test_optimality_conditions.jl (inputs; outputs "
     "computed here and matched to its KKT test)",
     "simplex(2)", "[1]", "[1.5,0,0.5,0,0]", "[1.5,0,0.5,0,0]", 1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/"
     "test_optimality_conditions.jl (inputs; outputs "
     "computed here and matched to its KKT test)",
     "simplex(5)", "[1]", "[1.5,1.5,3,3,6]", "[0,0,0.6666666666666665,0.6666666666666665,3.6666666666666665]",
     1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/"
     "test_optimality_conditions.jl (inputs; outputs "
     "computed here and matched to its KKT test)",
     "ball1(1)", "[1]", "[0.1,-0.1,0.2,-0.3,0.4,0.5]",
     "[2.7755575615628914e-17,-2.7755575615628914e-17,0.10000000000000003,-0.2,"
     "0.30000000000000004,0.4]",
     1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/"
     "test_optimality_conditions.jl (inputs; outputs "
     "computed here and matched to its KKT test)",
     "ball1(1.7)", "[1]", "[0.4,0.1,0.6,0.2,-0.1,-0.3,0.5]",
     "[0.32857142857142857,0.02857142857142854,0.5285714285714285,0."
     "12857142857142856,-0.02857142857142854,-"
     "0.22857142857142854,0.42857142857142855]",
     1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/"
     "test_optimality_conditions.jl (inputs; outputs "
     "computed here and matched to its KKT test)",
     "total_variation(1)", "[1]", "[-2,0.0625,0.125,0.1875,0.25,0.3125,0.375,0.4375,0.5,2.4375]",
     "[-1,0.0625,0.125,0.1875,0.25,0.3125,0.375,0.4375,0.5,1.4375]", 1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/"
     "test_optimality_conditions.jl (inputs; outputs "
     "computed here and matched to its KKT test)",
     "total_variation(0.01)", "[1]",
     "[1,0.7777777777777778,0.5555555555555556,0.33333333333333337,0."
     "11111111111111116,-0.11111111111111116,-"
     "0.33333333333333326,-0.5555555555555554,-0.7777777777777777,-1,-1,-1,-1,-"
     "1,-0.7777777777777778,-0."
     "5555555555555556,-0.33333333333333337,-0.11111111111111116,0."
     "11111111111111116,0.33333333333333326,0."
     "5555555555555554,0.7777777777777777,1]",
     "[0.99,0.7777777777777778,0.5555555555555556,0.33333333333333337,0."
     "11111111111111116,-0."
     "11111111111111116,-0.33333333333333326,-0.5555555555555554,-0."
     "7777777777777777,-0.9959999999999999,-0."
     "9959999999999999,-0.9960000000000001,-0.996,-0.996,-0.7777777777777778,-"
     "0.5555555555555556,-0."
     "33333333333333337,-0.11111111111111116,0.11111111111111116,0."
     "33333333333333326,0.5555555555555554,0."
     "7777777777777777,0.99]",
     1e-14},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_moreauEnvelope.jl "
     "(input)",
     "envelope(indicator(box(-1, 1)), 1)", "[0.5]", "[1,2,3,4,5]",
     "[1,1.6666666666666667,2.3333333333333335,3,3.666666666666667]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "linear([1])", "[0.5]", "[5]", "[4.5]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "norm1()", "[0.5]", "[0.3]", "[0]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "norm1()", "[0.5]", "[0.5]", "[0]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "squared_norm2()", "[0.3333333333333333]", "[6]", "[4.5]",
     1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "point(0)", "[1]", "[5]", "[0]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "orthant()", "[1]", "[-2]", "[0]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "box(-inf, 0)", "[1]", "[2]", "[0]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "box(0, 1)", "[1]", "[-0.5]", "[0]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "box(0, 1)", "[1]", "[0]", "[0]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "plq([0], [[0,0,0],[0,1,0]])", "[0.5]", "[3]", "[2.5]",
     1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "plq([0], [[0,0,0],[0,1,0]])", "[0.5]", "[-1]", "[-1]",
     1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "support(box(-1, 0))", "[0.5]", "[-0.3]", "[0]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "huber(1)", "[0.5]", "[0.5]", "[0.3333333333333333]",
     1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp", "huber(1)", "[0.5]", "[-5]", "[-4.5]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp (input; source checks "
     "r+exp(r)/rho=v, margin 1e-6)",
     "exponential()", "[1]", "[2]", "[0.4428544010023885]", 1e-14},
    {"foges/pogs@649ba26:tests/test_proximal.cpp (input; source checks "
     "r+exp(r)/rho=v, margin 1e-6)",
     "exponential()", "[1]", "[-1]", "[-1.278464542761074]", 1e-14},
    {"foges/pogs@649ba26:tests/test_cone_projections.cpp", "exponential_cone()", "[1]", "[0,1,3]", "[0,1,3]",
     1e-14},
    {"foges/pogs@649ba26:tests/test_cone_projections.cpp", "exponential_cone()", "[1]", "[1,-10,-1]",
     "[0,0,0]", 1e-14},
    {"foges/pogs@649ba26:tests/test_cone_projections.cpp", "dual_exponential_cone()", "[1]", "[0,1,1]",
     "[0,1,1]", 1e-14},
    // a diagonal metric
    {"odlgroup/odl@c1fdd54:src/odl/test/solvers/functional/"
     "default_functionals_test.py::test_weighted_proximal_L1_norm_close",
     "norm1()", "[0.1,0.2,0.5,1,2]", "[0.5,0.5,0.5,0.5,0.5]", "[0.4,0.3,0,0,0]", 1e-14},
    {"odlgroup/odl@c1fdd54:src/odl/test/solvers/nonsmooth/"
     "proximal_operator_test.py (closed form in source, "
     "8 digits; figures evaluated here)",
     "conjugate(norm1(2))", "[0.25]", "[-5,-4,-3,-2,-1,0,1,2,3,4]", "[-2,-2,-2,-2,-1,0,1,2,2,2]", 1e-14},
    // no 1/2 there
    {"odlgroup/odl@c1fdd54:src/odl/test/solvers/nonsmooth/"
     "proximal_operator_test.py (closed form in source, "
     "8 digits; figures evaluated here)",
     "conjugate(squared_norm2(4))", "[0.25]", "[-5,-4,-3,-2,-1,0,1,2,3,4]",
     "[-4.705882352941177,-3.764705882352941,-2.823529411764706,-1."
     "8823529411764706,-0.9411764705882353,0,0."
     "9411764705882353,1.8823529411764706,2.823529411764706,3.764705882352941]",
     1e-14},
    // 2 sum(x - g log x) up to a constant
    {"odlgroup/odl@c1fdd54:src/odl/test/solvers/nonsmooth/"
     "proximal_operator_test.py (closed form in source, "
     "8 digits; figures evaluated here)",
     "conjugate(separable(tilt(scale(log_barrier(), 20), 2), 1, "
     "tilt(scale(log_barrier(), 18), 2), 1, "
     "tilt(scale(log_barrier(), 16), 2), 1, tilt(scale(log_barrier(), 14), 2), "
     "1, tilt(scale(log_barrier(), "
     "12), 2), 1, tilt(scale(log_barrier(), 10), 2), 1, "
     "tilt(scale(log_barrier(), 8), 2), 1, "
     "tilt(scale(log_barrier(), 6), 2), 1, tilt(scale(log_barrier(), 4), 2), "
     "1, tilt(scale(log_barrier(), "
     "2), 2), 1))",
     "[0.25]", "[-5,-4,-3,-2,-1,0,1,2,3,4]",
     "[-5.653311931459037,-4.674234614174767,-3.7015621187164243,-2."
     "7386127875258306,-1.79128784747792,-0."
     "8708286933869707,0,0.7752551286084111,1.381966011250105,1."
     "775255128608411]",
     1e-14},
    {"odlgroup/odl@c1fdd54:src/odl/test/largescale/solvers/nonsmooth/"
     "default_functionals_slow_test.py::test_proximal_convex_conj_kl_cross_"
     "entropy_solving_opt_problem",
     "kullback_leibler([10,9,8,7,6,5,4,3,2,1])", "[2.3]", "[4,5,6,7,8,9,10,11,12,13]",
     "[5.412086092672593,5.951310282785328,6.483438308430583,7,7."
     "4898764763738646,7.937136339073651,8."
     "316516917443701,8.582452836563538,8.635666466800007,8.169158436779773]",
     1e-14},
    {"comp-imaging/ProxImaL@b9ba168:proximal/tests/test_prox_fn.py", "squared_norm2(2)", "[1]",
     "[0,1,2,3,4,5,6,7,8,9]",
     "[0,0.3333333333333333,0.6666666666666666,1,1.3333333333333333,1."
     "6666666666666667,2,2.3333333333333335,"
     "2.6666666666666665,3]",
     1e-14},
    {"comp-imaging/ProxImaL@b9ba168:proximal/tests/test_prox_fn.py (CVX "
     "reference, places=3; closed form "
     "evaluated here)",
     "sum(precompose(squared_norm2(4), "
     "[[-1,0,0,0,0,0,0,0,0,0],[0,-1,0,0,0,0,0,0,0,0],[0,0,-1,0,0,0,0,0,0,0],[0,"
     "0,0,-1,0,0,0,0,0,0],[0,0,0,0,-"
     "1,0,0,0,0,0],[0,0,0,0,0,-1,0,0,0,0],[0,0,0,0,0,0,-1,0,0,0],[0,0,0,0,0,0,"
     "0,-1,0,0],[0,0,0,0,0,0,0,0,-1,"
     "0],[0,0,0,0,0,0,0,0,0,-1]], [-1,-1,-1,-1,-1,-1,-1,-1,-1,-1]), "
     "linear([1,1,1,1,1,1,1,1,1,1]), "
     "squared_norm2(2))",
     "[0.5]", "[0,1,2,3,4,5,6,7,8,9]", "[-0.625,-0.375,-0.125,0.125,0.375,0.625,0.875,1.125,1.375,1.625]",
     1e-14},
    // weights below 0 count by their size there
    {"comp-imaging/ProxImaL@b9ba168:proximal/tests/test_prox_fn.py", "norm1([6,5,4,3,2,1,0,1,2,3])", "[0.5]",
     "[-5,-4,-3,-2,-1,0,1,2,3,4]", "[-2,-1.5,-1,-0.5,0,0,1,1.5,2,2.5]", 1e-14},
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py", "squared_norm2(6)",
     "[0.16666666666666666]", "[7]", "[3.5]", 1e-14},
    // a unitary transform changes nothing
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py", "translate(squared_norm2(4), [2,4])",
     "[1]", "[3,5]", "[2.2,4.2]", 1e-14},
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py", "translate(squared_norm2(4), [2,4])",
     "[1]", "[2.04,4.04]", "[2.008,4.008]", 1e-14},
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py",
     "precompose(squared_norm2(2), "
     "[[8,1,10],[1,9,1],[1.5,3.5,2.5],[0.75,3,3]], [-1,-2,-1.5,-3])",
     "[1]", "[6,7,3]", "[-0.345,0.298,0.388]", 0.001},
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py", "norm1(3)", "[1]", "[1,-4,5,-2]",
     "[0,-1,2,0]", 1e-14},
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py", "norm1([4,8,4,8])", "[1]",
     "[7,-9,10,-2]", "[3,-1,6,0]", 1e-14},
    // wrong in print: the source takes A'A = 2I for AA' = 2I
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py",
     "precompose(norm1(), [[1,0,0],[0,1,0],[0,0,1],[1,0,0],[0,1,0],[0,0,1]], "
     "[0,0,0,0,0,0])",
     "[1]", "[1,2,4]", "[0,0,2]", 1e-14},
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py",
     "affine([[1,1,1,1,1,1,1,1,1,1]], [10])", "[1]", "[0,0,0,0,0,0,0,0,0,0]", "[1,1,1,1,1,1,1,1,1,1]", 1e-14},
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py",
     "hyperplane([1,1,1,1,1,1,1,1,1,1], 10)", "[1]", "[0,0,0,0,0,0,0,0,0,0]", "[1,1,1,1,1,1,1,1,1,1]", 1e-14},
    {"epfl-lts2/unlocbox@5ee6f89:test_bench/test_prox_l2.m", "squared_norm2(2)", "[1]", "[3,-1.5,0.75]",
     "[1,-0.5,0.25]", 1e-14},
    {"matbesancon/MathOptSetDistances.jl@815c9fd:test/projections.jl", "psd_cone()", "[1]",
     "[1,1.4142135623730951,1.4142135623730951,1]", "[1.20710678,1.20710678,1.20710678,1.20710678]", 1e-08},
    {"matbesancon/MathOptSetDistances.jl@815c9fd:test/projections.jl "
     "\"Difficult Projections\"",
     "power_cone(0.5)", "[1]", "[1.2782001669773202,-0.024746244349335353,0.020923505930442263]",
     "[1.2782063854999521,0.00031714354240036126,0.020133924133566627]", 1e-06},
    {"matbesancon/MathOptSetDistances.jl@815c9fd:test/projections.jl "
     "\"Difficult Projections\"",
     "power_cone(0.05)", "[1]", "[-1.0626658716421513,0.2640095391880903,-0.18047124406952353]",
     "[5.017573743125674e-05,0.2677927971680596,-0.17435469047436508]", 1e-06},
    {"mbayediongue/proxop@d00e224:src/proxop/scalar/AbsValue.py", "norm1()", "[1]", "[-3,1,6]", "[-2,0,5]",
     1e-14},
    {"mbayediongue/proxop@d00e224:src/proxop/scalar/Entropy.py", "entropy()", "[1]",
     "[-2,3,4,2.718281828459045]", "[0.04747849,1.5571456,2.20794003,1.38940572]", 1e-08},
    {"mbayediongue/proxop@d00e224:src/proxop/scalar/Exp.py", "exponential()", "[1]",
     "[-2,3,4,0.6931471805599453]", "[-2.12002824,0.79205997,1.07372894,-0.15945832]", 1e-08},
    {"mbayediongue/proxop@d00e224:src/proxop/scalar/Log.py", "log_barrier()", "[1]", "[-2,3,4]",
     "[0.41421356,3.30277564,4.23606798]", 1e-08},
    {"mbayediongue/proxop@d00e224:src/proxop/scalar/FermiDiracEntropy.py", "binary_entropy()", "[1]",
     "[-2,3,4,2.718281828459045]", "[0.10829336,0.89170664,0.9545842,0.86456313]", 1e-08},
    {"mbayediongue/proxop@d00e224:src/proxop/scalar/Hyperbolic.py", "precompose(norm2(), [[1],[0]], [0,3])",
     "[1]", "[-2]", "[-1.54269095]", 1e-08},
    {"mbayediongue/proxop@d00e224:src/proxop/scalar/Hyperbolic.py", "precompose(norm2(), [[1],[0]], [0,3])",
     "[1]", "[3]", "[2.37870272]", 1e-08},
    {"mbayediongue/proxop@d00e224:src/proxop/scalar/Hyperbolic.py", "precompose(norm2(), [[1],[0]], [0,3])",
     "[1]", "[4]", "[3.26376922]", 1e-08},
    {"mbayediongue/proxop@d00e224:src/proxop/scalar/Huber.py", "scale(huber(3), 3)", "[2.5]",
     "[-2,3,4,2.718281828459045]", "[-0.57142857,0.85714286,1.14285714,0.77665195]", 1e-08},
    // wrong in print: Newton diverged there
    {"mbayediongue/proxop@d00e224:src/proxop/scalar/Inverse.py", "inverse_power(2)", "[1]", "[-2,3,4]",
     "[0.8850335036485176,3.069177368017996,4.030544899823623]", 1e-14},
};

Function made(const std::string& text, convex::Index n) {
  return convex::make_function(cli::parse_call(text, "f"), Space{Metric::identity(n)});
}

Vector vector(const std::string& text) { return cli::parse_vector(text, "vector"); }

}  // namespace

TEST_CASE(
    "proxes in other libraries' tests and manuals are found, those wrong "
    "in print corrected") {
  for (const PeerProx& peer : peer_proxes) {
    CAPTURE(peer.source);
    CAPTURE(peer.f);
    const Vector z = vector(peer.z), expected = vector(peer.x);
    Vector gamma = vector(peer.gamma);
    if (gamma.size() == 1) gamma = Vector::Constant(z.size(), gamma[0]);
    const auto x = made(peer.f, z.size()).prox(z, Metric::diagonal(gamma.cwiseInverse()));
    CAPTURE(x.x.transpose());
    REQUIRE(x.status == convex::Status::solved);
    CHECK((x.x - expected).norm() <= peer.tolerance * (expected.norm() + z.norm()));
  }
}
