#include "convex/catalogue/catalogue.hpp"
#include "convex/nearest_name.hpp"

namespace convex::inline function_catalogue {
namespace {

/// What other languages and fields call an entry of the catalogue.
struct OtherName {
  std::string_view name, here;
};
constexpr OtherName other_names[] = {
    {"l1", "norm1()"},
    {"l1_norm", "norm1()"},
    {"norm_1", "norm1()"},
    {"lasso", "norm1()"},
    {"abs", "norm1()"},
    {"l2", "norm2()"},
    {"l2_norm", "norm2()"},
    {"norm", "norm2()"},
    {"euclidean", "norm2()"},
    {"linf", "norm_inf()"},
    {"norminf", "norm_inf()"},
    {"max_norm", "norm_inf()"},
    {"chebyshev", "norm_inf()"},
    {"ridge", "squared_norm2()"},
    {"tikhonov", "squared_norm2()"},
    {"sum_squares", "squared_norm2()"},
    {"sqr_norm_l2", "squared_norm2()"},
    {"least_squares", "precompose(squared_norm2(), A, b)"},
    {"tv", "total_variation()"},
    {"fused_lasso", "total_variation()"},
    {"group_lasso", "group_norm(sizes)"},
    {"l21", "group_norm(sizes)"},
    {"slope", "sorted_norm1(weights)"},
    {"owl", "sorted_norm1(weights)"},
    {"trace_norm", "nuclear_norm(rows)"},
    {"nuclear", "nuclear_norm(rows)"},
    {"logdet", "neg_log_det()"},
    {"quantile", "pinball(tau)"},
    {"check_loss", "pinball(tau)"},
    {"logsumexp", "log_sum_exp()"},
    {"lse", "log_sum_exp()"},
    {"lambda_max", "max_eigenvalue()"},
    {"schatten_norm", "schatten(p, rows)"},
    {"spectral_norm", "schatten(inf, rows)"},
    {"tv2d", "total_variation_2d(rows)"},
    {"ksupport", "k_support(k)"},
    {"log_det", "neg_log_det()"},
    {"kl", "kullback_leibler()"},
    {"neg_entropy", "entropy()"},
    {"negative_entropy", "entropy()"},
    {"exp", "exponential()"},
    {"log", "log_barrier()"},
    {"svm", "hinge()"},
    {"softplus", "logistic()"},
    {"ball", "ball2()"},
    {"l2_ball", "ball2()"},
    {"l1_ball", "ball1()"},
    {"linf_ball", "ball_inf()"},
    {"interval", "box(lower, upper)"},
    {"nonnegative", "orthant()"},
    {"nonneg", "orthant()"},
    {"positive", "orthant()"},
    {"psd", "psd_cone()"},
    {"sdp", "psd_cone()"},
    {"soc", "second_order_cone()"},
    {"lorentz", "second_order_cone()"},
    {"ice_cream", "second_order_cone()"},
    {"isotonic", "monotone_cone()"},
    {"moreau", "envelope(f, gamma)"},
    {"moreau_envelope", "envelope(f, gamma)"},
    {"fenchel", "conjugate(f)"},
    {"legendre", "conjugate(f)"},
    {"infimal_convolution", "inf_convolution(f, g)"},
    {"infconv", "inf_convolution(f, g)"},
    {"compose", "precompose(f, A, b)"},
    {"shift", "translate(f, by)"},
    {"plus", "sum(f, g)"},
    {"times", "scale(f, alpha)"},
    {"dist", "distance(set)"},
};

/// Functions that are not convex, and what is written in their place.
constexpr OtherName not_convex[] = {
    {"l0", "norm1(), which is the largest convex function below it on the cube"},
    {"cardinality", "norm1(), which is the largest convex function below it on the cube"},
    {"rank", "nuclear_norm(rows), which is the largest convex function below it on the spectral ball"},
    {"min", "the parts of it by themselves"},
};

}  // namespace

std::string unknown_entry(std::string_view name) {
  const std::string there_is_none = "there is no set, function or operation \"" + std::string(name) + "\"; ";
  for (const OtherName& other : other_names)
    if (other.name == name) return there_is_none + "here it is " + std::string(other.here);
  for (const OtherName& other : not_convex)
    if (other.name == name)
      return "\"" + std::string(name) + "\" is not convex; use " + std::string(other.here);
  std::vector<std::string> names;
  for (const CatalogueEntry& entry : catalogue()) names.emplace_back(entry.name);
  const std::string nearest = nearest_name(name, names);
  if (nearest.empty()) {
    std::vector<std::string> elsewhere;
    for (const OtherName& other : other_names) elsewhere.emplace_back(other.name);
    const std::string near = nearest_name(name, elsewhere);
    for (const OtherName& other : other_names)
      if (other.name == near && name.size() > 2)
        return there_is_none + "did you mean \"" + near + "\", here " + std::string(other.here) + "?";
  }
  return there_is_none + (nearest.empty() ? "" : "did you mean \"" + nearest + "\"? ") +
         "`moreau functions` lists them";
}

}  // namespace convex::inline function_catalogue
