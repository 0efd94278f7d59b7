#include "cli/function_language/domain_text.hpp"

#include <cmath>
#include <vector>

#include "convex/catalogue/catalogue.hpp"

namespace cli::inline function_language {
namespace {

using convex::Argument;
using convex::Call;
using convex::Index;

constexpr const char* everywhere = "everywhere";

/// The arguments of a call by the names of the catalogue.
class Given {
 public:
  explicit Given(const Call& call) : call_(call), entry_(convex::find_entry(call.name)) {}

  /// Null when the parameter was left to its default.
  const Argument* value(std::string_view parameter) const {
    for (std::size_t i = 0; i < call_.arguments.size(); ++i) {
      const convex::NamedArgument& argument = call_.arguments[i];
      if (argument.key == parameter) return &argument.value;
      if (argument.key.empty() && entry_ != nullptr && i < entry_->parameters.size() &&
          entry_->parameters[i].name == parameter)
        return &argument.value;
    }
    return nullptr;
  }
  const Call* call(std::string_view parameter) const {
    const Argument* given = value(parameter);
    const auto* nested = given == nullptr ? nullptr : std::get_if<std::shared_ptr<const Call>>(given);
    return nested == nullptr ? nullptr : nested->get();
  }
  std::string text(std::string_view parameter) const {
    const Argument* given = value(parameter);
    if (given == nullptr) return "";
    const std::string written = to_text(Call{"", {{"", *given, {}}}, {}});  // in parentheses
    return written.substr(1, written.size() - 2);
  }
  std::vector<const Call*> calls() const {
    std::vector<const Call*> found;
    for (const convex::NamedArgument& argument : call_.arguments)
      if (const auto* nested = std::get_if<std::shared_ptr<const Call>>(&argument.value))
        found.push_back(nested->get());
    return found;
  }

 private:
  const Call& call_;
  const convex::CatalogueEntry* entry_;
};

std::string domain_of(const Call& call, Index n) {
  return domain_text(convex::make_function(call, {convex::Metric::identity(n)}), n);
}

/// The domain of a part, changed by a rule; what is everywhere stays so.
template <class Rule>
std::string changed(const Call* part, Index n, const Rule& rule) {
  if (part == nullptr) return "";
  const std::string domain = domain_of(*part, n);
  return domain.empty() || domain == everywhere ? domain : rule(domain);
}

/// The domains of all parts, `everywhere` ones left out, joined by a word.
std::string joined(const std::vector<const Call*>& parts, Index n, const std::string& word) {
  std::string text;
  for (const Call* part : parts) {
    const std::string domain = domain_of(*part, n);
    if (domain.empty()) return "";
    if (domain == everywhere) continue;
    if (text.find("(" + domain + ")") == std::string::npos)
      text += (text.empty() ? "(" : word + "(") + domain + ")";
  }
  if (text.empty()) return everywhere;
  const bool alone = text.find(word) == std::string::npos;
  return alone ? text.substr(1, text.size() - 2) : text;
}

/// Of a piecewise quadratic: between the first and the last piece that is finite.
std::string of_pieces(const Given& given) {
  const Argument *breaks = given.value("breaks"), *pieces = given.value("coefficients");
  if (breaks == nullptr || pieces == nullptr || !std::holds_alternative<convex::Matrix>(*pieces)) return "";
  convex::Vector at(1);
  if (const auto* many = std::get_if<convex::Vector>(breaks))
    at = *many;
  else if (const auto* one = std::get_if<double>(breaks))
    at[0] = *one;
  else
    return "";
  const auto& rows = std::get<convex::Matrix>(*pieces);
  double low = -INFINITY, high = INFINITY;
  for (Index j = 0; j < at.size() && std::isinf(rows(j, 0)); ++j) low = at[j];
  for (Index j = at.size(); j > 0 && std::isinf(rows(j, 0)); --j) high = at[j - 1];
  if (std::isinf(low) && std::isinf(high)) return everywhere;
  return to_text(Call{"box", {convex::argument("", low), convex::argument("", high)}});
}

/// "box(0, 1) for entry 1, everywhere for entries 2 to 3".
std::string of_blocks(const Call& call) {
  std::string text;
  Index first = 1;
  for (std::size_t k = 0; k + 1 < call.arguments.size(); k += 2) {
    const auto* part = std::get_if<std::shared_ptr<const Call>>(&call.arguments[k].value);
    const auto* count = std::get_if<double>(&call.arguments[k + 1].value);
    if (part == nullptr || count == nullptr) return "";
    const Index last = first + static_cast<Index>(*count) - 1;
    const std::string domain = domain_of(**part, static_cast<Index>(*count));
    if (domain.empty()) return "";
    text += (text.empty() ? "" : ", ") + domain + " for ";
    text += first == last ? "entry " + std::to_string(first)
                          : "entries " + std::to_string(first) + " to " + std::to_string(last);
    first = last + 1;
  }
  return text;
}

std::string of_operation(const Call& call, Index n) {
  const Given given(call);
  if (call.name == "plq") return of_pieces(given);
  const Call* f = given.call("f");
  const auto same = [](const std::string& domain) { return domain; };
  if (call.name == "tilt" || call.name == "scale") return changed(f, n, same);
  if (call.name == "translate")
    return changed(f, n, [&](const std::string& domain) { return given.text("by") + " + (" + domain + ")"; });
  if (call.name == "dilate")
    return changed(f, n, [&](const std::string& domain) { return given.text("rho") + " (" + domain + ")"; });
  if (call.name == "sum" || call.name == "pointwise_max") return joined(given.calls(), n, " and ");
  if (call.name == "precompose") {
    const Argument* A = given.value("A");
    if (A == nullptr || !std::holds_alternative<convex::Matrix>(*A)) return "";
    const std::string b = given.text("b");
    return changed(f, std::get<convex::Matrix>(*A).rows(), [&](const std::string& domain) {
      return given.text("A") + "y" + (b.empty() ? "" : " + " + b) + " in (" + domain + ")";
    });
  }
  if (call.name == "separable") return of_blocks(call);
  // sup of v.x - max_i (a_i.x + b_i) is finite where v is a mean of the a_i (Rockafellar 1970, theorem 16.5).
  if (call.name == "conjugate" && f != nullptr && f->name == "max_affine")
    return "the convex hull of the rows of A";
  if (call.name == "inf_convolution") {
    std::string text;
    for (const Call* part : given.calls()) {
      const std::string domain = domain_of(*part, n);
      if (domain.empty() || domain == everywhere) return domain;
      text += (text.empty() ? "(" : " + (") + domain + ")";
    }
    return text;
  }
  return "";
}

}  // namespace

std::string domain_text(const convex::Function& f, Index n) {
  if (f.facts().finite) return everywhere;
  const Call call = f.call();
  if (call.name == "indicator" && call.arguments.size() == 1)
    if (const auto* set = std::get_if<std::shared_ptr<const Call>>(&call.arguments[0].value))
      return to_text(**set);
  const convex::CatalogueEntry* entry = convex::find_entry(call.name);
  if (entry == nullptr) return "";
  if (entry->kind == convex::EntryKind::set) return to_text(call);
  if (!entry->domain.empty()) return std::string(entry->domain);
  return of_operation(call, n);
}

}  // namespace cli::inline function_language
