#include <doctest/doctest.h>

#ifdef __x86_64__
#include <cpuid.h>

#include <cstdint>
#include <cstring>

#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/gamma0/function.hpp"

using namespace convex;

namespace {

/// Can XGETBV tell which parts of the registers are in use (CPUID leaf 13, subleaf 1, EAX bit 2), and is it
/// a processor whose upper halves slow down what does not write them?
bool tells_upper_halves() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  char vendor[12];
  if (!__get_cpuid(0, &a, &b, &c, &d)) return false;
  std::memcpy(vendor, &b, 4);
  std::memcpy(vendor + 4, &d, 4);
  std::memcpy(vendor + 8, &c, 4);
  return std::memcmp(vendor, "GenuineIntel", 12) == 0 && __get_cpuid_count(13, 1, &a, &b, &c, &d) && (a & 4);
}

/// Are bits 128 to 255 of the vector registers in use (XINUSE, component 2)?
bool upper_halves_in_use() {
  std::uint32_t low = 0, high = 0;
  asm volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(1));
  return (low & 4) != 0;
}

}  // namespace

TEST_CASE(
    "proxes leave the upper halves of registers clean, or logarithms after them take five times as long") {
  if (!tells_upper_halves()) return;
  asm volatile("vzeroupper");
  REQUIRE_FALSE(upper_halves_in_use());
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.kind == EntryKind::operation) continue;
    const std::string text(entry.examples.front());
    CAPTURE(text);
    const Call call = cli::parse_call(text, "f");
    const Index n = cli::number_of_entries(call);
    const Metric W = Metric::diagonal(Vector::Constant(n, 2));
    const Function f = make_function(call, {W});
    const Vector z = Vector::LinSpaced(n, -3, 5);
    for (const Function& h : {f, f.conjugate()}) {
      asm volatile("vzeroupper");
      h.prox(z, W);
      CHECK_FALSE(upper_halves_in_use());
    }
  }
}
#endif
