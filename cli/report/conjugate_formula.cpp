#include "cli/report/conjugate_formula.hpp"

#include "convex/catalogue/catalogue.hpp"

namespace cli::inline reports {
namespace {

using convex::Call;

/// The call that an argument by position or name is, if it is one.
const Call* nested_call(const Call& call) {
  if (call.arguments.empty()) return nullptr;
  const auto* nested = std::get_if<std::shared_ptr<const Call>>(&call.arguments[0].value);
  return nested == nullptr ? nullptr : nested->get();
}

/// The conjugate of a part, written in the language; a part with data tells the number of its entries.
std::string conjugate_of_part(const Call& part, convex::Index entries) {
  const convex::Function f = convex::make_function(part, {convex::Metric::identity(entries)});
  return to_text(f.conjugate().call());
}

}  // namespace

std::string conjugate_formula(const Call& f, convex::Index entries) {
  if (f.name == "neg_log_det")
    return "-n - log det(-(Y + Y^T)/2), Y the n x n matrix of y; +inf where that is not positive definite";
  if (f.name == "max_affine")
    return "min -b.l over l >= 0 with sum l = 1 and A^T l = y; +inf where there is no such l";
  const bool is_indicator = f.name == "indicator";
  const Call* lifted = is_indicator ? nested_call(f) : &f;
  if (lifted == nullptr || (lifted->name != "perspective" && lifted->name != "epigraph")) return "";
  const Call* part = nested_call(*lifted);
  if (part == nullptr || entries < 2) return "";
  const std::string g = conjugate_of_part(*part, entries - 1);
  if (lifted->name == "perspective") return "0 where h(v) + r <= 0, y = (v, r), else +inf, h = " + g;
  return "-r h(-v/r) for r < 0, y = (v, r), its limit at r = 0, +inf for r > 0, h = " + g;
}

}  // namespace cli::inline reports
