#include <doctest/doctest.h>

#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/laws/call_laws.hpp"

using namespace convex;

TEST_CASE("the laws of Moreau's decomposition hold for the sets and functions of the catalogue") {
  // `moreau check --catalogue` tries every example in four metrics; here is the first of each in one.
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.kind == EntryKind::operation) continue;
    const std::string text(entry.examples.front());
    CAPTURE(text);
    const Call call = cli::parse_call(text, "f");
    const Index n = cli::number_of_entries(call);
    const LawReport report = laws(call, {trial_metrics(n)[2]});
    INFO(report.text());
    CHECK(report.all_passed());
  }
}

TEST_CASE("the laws hold for operations, whose proxes come by other routes than their conjugates'") {
  for (const char* text :
       {"translate(norm1(2), [1,-2,0.5])", "envelope(norm1(), 0.5)", "sum(norm1(), squared_norm2(2))",
        "separable(norm1(), 1, norm2(), 2)", "precompose(norm2(), [[0,1,0],[0,0,1],[1,0,0]], [1,2,3])",
        "dilate(hinge(), -2)", "conjugate(logistic())"}) {
    CAPTURE(text);
    const LawReport report = laws(cli::parse_call(text, "f"), {trial_metrics(3)[1]});
    INFO(report.text());
    CHECK(report.all_passed());
  }
}

TEST_CASE("a call that cannot be made fails its laws with the reason") {
  const LawReport report = laws(cli::parse_call("indicator(ball2(-1))", "f"), 2);
  CHECK_FALSE(report.all_passed());
  CHECK(report.text().find("negative") != std::string::npos);
}
