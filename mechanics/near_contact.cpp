#include "mechanics/near_contact.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/number_text.hpp"

namespace mechanics {
namespace {

/// The smallest power of ten that is at least x.
std::string power_of_ten_above(double x) {
  int exponent = static_cast<int>(std::ceil(std::log10(x)));
  if (std::stod("1e" + std::to_string(exponent)) < x) ++exponent;
  return "1e" + std::to_string(exponent);
}

}  // namespace

std::optional<Warning> near_contacts(const System& system, const State& state, const Contacts& contacts,
                                     const Vector& q2) {
  const ConstraintRates& rates = contacts.rates;
  const auto& constraints = system.constraints();
  std::vector<Index> close;
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    const auto a = static_cast<Index>(k);
    if (!constraints[k].two_sided && std::abs(rates.f[a]) <= near_contact_tolerance * rates.f_scale[a] &&
        std::abs(rates.df[a]) <= near_contact_tolerance * rates.df_scale[a] &&
        !std::binary_search(contacts.present.begin(), contacts.present.end(), a))
      close.push_back(a);
  }
  if (close.empty()) return std::nullopt;
  const ContactRows rows = system.contact_rows(state, close);
  const Vector second = rows.U * q2 - rows.s, terms = rows.U.cwiseAbs() * q2.cwiseAbs() + rows.s.cwiseAbs();
  Warning warning{Warning::Kind::near_contact, {}, ""};
  double needed = 0;
  for (std::size_t k = 0; k < close.size(); ++k) {
    const auto row = static_cast<Index>(k);
    const Index a = close[k];
    constexpr double rounding = 0x1p-40;
    if (!(second[row] < -rounding * terms[row])) continue;
    needed = std::max(
        {needed, std::abs(rates.f[a]) / rates.f_scale[a], std::abs(rates.df[a]) / rates.df_scale[a]});
    constexpr std::size_t most_told = 4;
    if (warning.constraints.size() < most_told)
      warning.message += (warning.constraints.empty() ? "" : "; ") +
                         constraints[static_cast<std::size_t>(a)].name + ": f = " + number_text(rates.f[a]) +
                         ", df/dt = " + number_text(rates.df[a]) +
                         " and d²f/dt² = " + number_text(second[row]) + " < 0";
    warning.constraints.push_back(a);
  }
  if (warning.constraints.empty()) return std::nullopt;
  const std::size_t count = warning.constraints.size();
  warning.message +=
      std::string(count > 4 ? " …" : "") + ". " + (count == 1 ? "This is" : "These are") +
      " nearly in contact and not counted so; if contact is meant, set [solve] contact_tolerance = " +
      power_of_ten_above(needed) + " or give the state with more digits";
  return warning;
}

std::vector<Index> closed_by_tolerance(const WrittenMechanism& written, const Contacts& contacts) {
  const ConstraintRates& rates = contacts.rates;
  std::vector<Index> suspects;
  for (const Index a : contacts.present)
    if (!written.system->constraints()[static_cast<std::size_t>(a)].two_sided &&
        !std::binary_search(written.in_contact.begin(), written.in_contact.end(), a) &&
        (rates.f[a] != 0 || rates.df[a] != 0))
      suspects.push_back(a);
  if (suspects.empty()) return suspects;
  const RateRadii radii = rate_radii(*written.system, written.state, written.radii);
  std::erase_if(suspects, [&](Index a) {
    return std::abs(rates.f[a]) <= radii.f[a] && std::abs(rates.df[a]) <= radii.df[a];
  });
  return suspects;
}

}  // namespace mechanics
