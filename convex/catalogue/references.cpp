#include "convex/catalogue/references.hpp"

#include <algorithm>
#include <string>

#include "convex/invalid_input.hpp"

namespace convex::inline function_catalogue {
namespace {

constexpr Reference works[] = {
    {"Argyriou, Foygel and Srebro 2012",
     "A. Argyriou, R. Foygel, N. Srebro, Sparse prediction with the k-support norm, Adv. Neural Inf. "
     "Process. "
     "Syst. 25, 1457-1465"},
    {"Ayer, Brunk, Ewing, Reid and Silverman 1955",
     "M. Ayer, H. D. Brunk, G. M. Ewing, W. T. Reid, E. Silverman, An empirical distribution function for "
     "sampling "
     "with incomplete information, Ann. Math. Statist. 26, 641-647"},
    {"Bauschke and Combettes 2017",
     "H. H. Bauschke, P. L. Combettes, Convex Analysis and Monotone Operator Theory in Hilbert Spaces, "
     "second "
     "edition, Springer"},
    {"Bauschke, Goebel, Lucet and Wang 2008",
     "H. H. Bauschke, R. Goebel, Y. Lucet, X. Wang, The proximal average: basic theory, SIAM J. Optim. 19, "
     "766-785"},
    {"Beck 2017", "A. Beck, First-Order Methods in Optimization, SIAM"},
    {"Bogdan et al. 2015",
     "M. Bogdan, E. van den Berg, C. Sabatti, W. Su, E. J. Candès, SLOPE: adaptive variable selection via "
     "convex "
     "optimization, Ann. Appl. Stat. 9, 1103-1140"},
    {"Briceno-Arias et al. 2019",
     "L. M. Briceño-Arias, G. Chierchia, E. Chouzenoux, J.-C. Pesquet, A random block-coordinate "
     "Douglas-Rachford "
     "splitting method with low computational complexity for binary logistic regression, Comput. Optim. "
     "Appl. 72, "
     "707-726"},
    {"Cai, Candes and Shen 2010",
     "J.-F. Cai, E. J. Candès, Z. Shen, A singular value thresholding algorithm for matrix completion, SIAM "
     "J. "
     "Optim. 20, 1956-1982"},
    {"Chaux et al. 2007",
     "C. Chaux, P. L. Combettes, J.-C. Pesquet, V. R. Wajs, A variational formulation for frame-based "
     "inverse "
     "problems, Inverse Problems 23, 1495-1518"},
    {"Combettes and Pesquet 2007",
     "P. L. Combettes, J.-C. Pesquet, A Douglas-Rachford splitting approach to nonsmooth convex variational "
     "signal "
     "recovery, IEEE J. Sel. Top. Signal Process. 1, 564-574"},
    {"Combettes and Pesquet 2011",
     "P. L. Combettes, J.-C. Pesquet, Proximal splitting methods in signal processing, in: Fixed-Point "
     "Algorithms "
     "for Inverse Problems in Science and Engineering, Springer, 185-212"},
    {"Combettes and Wajs 2005",
     "P. L. Combettes, V. R. Wajs, Signal recovery by proximal forward-backward splitting, Multiscale Model. "
     "Simul. 4, 1168-1200"},
    {"Condat 2013",
     "L. Condat, A direct algorithm for 1-D total variation denoising, IEEE Signal Process. Lett. 20, "
     "1054-1057"},
    {"Condat 2016",
     "L. Condat, Fast projection onto the simplex and the l1 ball, Math. Program. 158, 575-585"},
    {"Cortes and Vapnik 1995", "C. Cortes, V. Vapnik, Support-vector networks, Mach. Learn. 20, 273-297"},
    {"Davies and Kovac 2001",
     "P. L. Davies, A. Kovac, Local extremes, runs, strings and multiresolution, Ann. Statist. 29, 1-65"},
    {"Donoho and Johnstone 1994",
     "D. L. Donoho, I. M. Johnstone, Ideal spatial adaptation by wavelet shrinkage, Biometrika 81, 425-455"},
    {"Fenchel 1949", "W. Fenchel, On conjugate convex functions, Canad. J. Math. 1, 73-77"},
    {"Friberg 2023",
     "H. A. Friberg, Projection onto the exponential cone: a univariate root-finding problem, Optim. Methods "
     "Softw. 38, 457-473"},
    {"Gardiner and Lucet 2010",
     "B. Gardiner, Y. Lucet, Convex hull algorithms for piecewise linear-quadratic functions in "
     "computational "
     "convex analysis, Set-Valued Var. Anal. 18, 467-482"},
    {"Goldfarb and Idnani 1983",
     "D. Goldfarb, A. Idnani, A numerically stable dual method for solving strictly convex quadratic "
     "programs, "
     "Math. Program. 27, 1-33"},
    {"Hien 2015",
     "L. T. K. Hien, Differential properties of Euclidean projection onto power cone, Math. Methods Oper. "
     "Res. 82, "
     "265-284"},
    {"Higham 1988",
     "N. J. Higham, Computing a nearest symmetric positive semidefinite matrix, Linear Algebra Appl. 103, "
     "103-118"},
    {"Huber 1964", "P. J. Huber, Robust estimation of a location parameter, Ann. Math. Statist. 35, 73-101"},
    {"Koenker and Bassett 1978", "R. Koenker, G. Bassett, Regression quantiles, Econometrica 46, 33-50"},
    {"Kullback and Leibler 1951",
     "S. Kullback, R. A. Leibler, On information and sufficiency, Ann. Math. Statist. 22, 79-86"},
    {"Lawson and Hanson 1974", "C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, Prentice-Hall"},
    {"Lewis 1996", "A. S. Lewis, Convex analysis on the Hermitian matrices, SIAM J. Optim. 6, 164-177"},
    {"Mammen and van de Geer 1997",
     "E. Mammen, S. van de Geer, Locally adaptive regression splines, Ann. Statist. 25, 387-413"},
    {"Moreau 1962",
     "J. J. Moreau, Fonctions convexes duales et points proximaux dans un espace hilbertien, C. R. Acad. "
     "Sci. "
     "Paris 255, 2897-2899; Décomposition orthogonale d'un espace hilbertien selon deux cônes mutuellement "
     "polaires, same volume, 238-240"},
    {"Moreau 1963",
     "J. J. Moreau, Inf-convolution des fonctions numériques sur un espace vectoriel, C. R. Acad. Sci. Paris "
     "256, "
     "5047-5049"},
    {"Moreau 1965",
     "J. J. Moreau, Proximité et dualité dans un espace hilbertien, Bull. Soc. Math. France 93, 273-299"},
    {"Moreau 1966",
     "J. J. Moreau, Quadratic programming in mechanics: dynamics of one-sided constraints, SIAM J. Control "
     "4, "
     "153-158"},
    {"Rockafellar 1970", "R. T. Rockafellar, Convex Analysis, Princeton University Press"},
    {"Rudin, Osher and Fatemi 1992",
     "L. I. Rudin, S. Osher, E. Fatemi, Nonlinear total variation based noise removal algorithms, Physica D "
     "60, "
     "259-268"},
    {"Wang and Lu 2015", "W. Wang, C. Lu, Projection onto the capped simplex, arXiv:1503.01002"},
    {"Yu 2013",
     "Y.-L. Yu, On decomposing the proximal map, Advances in Neural Information Processing Systems 26, "
     "91-99"},
    {"Yuan and Lin 2006",
     "M. Yuan, Y. Lin, Model selection and estimation in regression with grouped variables, J. R. Stat. Soc. "
     "B 68, "
     "49-67"},
    {"Zou and Hastie 2005",
     "H. Zou, T. Hastie, Regularization and variable selection via the elastic net, J. R. Stat. Soc. B 67, "
     "301-320"},
};

/// "Rockafellar 1970" of " Rockafellar 1970, Theorem 16.4"; "" when there is no year.
std::string_view name_in(std::string_view part) {
  constexpr std::size_t year = 4;
  part.remove_prefix(std::min(part.find_first_not_of(' '), part.size()));
  std::size_t digits = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    digits = part[i] >= '0' && part[i] <= '9' ? digits + 1 : 0;
    if (digits == year) return part.substr(0, i + 1);
  }
  return {};
}

}  // namespace

std::span<const Reference> references() { return works; }

std::vector<Reference> references_of(std::string_view source) {
  std::vector<Reference> cited;
  for (std::size_t begin = 0; begin <= source.size();) {
    const std::size_t end = std::min(source.find(';', begin), source.size());
    const std::string_view name = name_in(source.substr(begin, end - begin));
    begin = end + 1;
    if (name.empty()) continue;
    const auto* work = std::ranges::find(works, name, &Reference::name);
    if (work == std::end(works))
      throw InvalidInput("references_of: there is no work \"" + std::string(name) +
                         "\"; add it to convex/catalogue/references.cpp");
    cited.push_back(*work);
  }
  return cited;
}

}  // namespace convex::inline function_catalogue
