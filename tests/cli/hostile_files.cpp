#include <cstdint>

#include <nlohmann/json.hpp>

#include "tests/cli/error_form.hpp"

using namespace tests;

namespace {

constexpr std::size_t many = 20000, ten_megabytes = 10000000;

std::string repeated(const std::string& part, std::size_t count) {
  std::string text;
  text.reserve(part.size() * count);
  for (std::size_t i = 0; i < count; ++i) text += part;
  return text;
}

std::string potential(const std::string& V) { return point_on_floor({{4, "potential = \"" + V + "\""}}); }

}  // namespace

TEST_CASE("nesting is refused from a depth on, however it is written, and never overflows the stack") {
  for (const std::string& V :
       {repeated("(", many) + "y" + repeated(")", many), repeated("-", many) + "y",
        repeated("y^", many) + "y", repeated("sin(", many) + "y" + repeated(")", many), repeated("(", many),
        repeated("2^-", many) + "y", repeated("sum(i in 1..1, ", many) + "y" + repeated(")", many)})
    CHECK(run_on("solve", potential(V)).code == 2);
  expect_refusal({potential(repeated("(", many) + "y" + repeated(")", many)), "4:270", {"256"}});
}

TEST_CASE("a depth of 256 is allowed") {
  constexpr std::size_t allowed = 256;
  CHECK(run_on("solve", potential(repeated("(", allowed) + "y" + repeated(")", allowed))).code == 0);
}

TEST_CASE("what is long and not nested is read") {
  CHECK(run_on("solve", potential(repeated("y+", many) + "y")).code == 0);
  std::string chain = "[system.definitions]\nd0 = \"y\"\n";
  for (std::size_t i = 1; i <= many; ++i)
    chain += "d" + std::to_string(i) + " = \"d" + std::to_string(i - 1) + " + 1\"\n";
  CHECK(run_on("solve", point_on_floor({{14, chain}})).code == 0);
}

TEST_CASE("ten megabytes of nonsense are refused") {
  std::string random(ten_megabytes, '\0');
  std::uint32_t state = 1966;
  for (char& c : random) c = static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
  for (const std::string& text :
       {random, std::string(ten_megabytes, 'a'), std::string(ten_megabytes, '['),
        std::string(ten_megabytes, '\0'), std::string(ten_megabytes, '\n'),
        "x = " + std::string(ten_megabytes, '['), "x = \"" + std::string(ten_megabytes, 'a'),
        "x = " + repeated("{a=", many)}) {
    const Outcome outcome = run_on("solve", text);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.size() < 500);
  }
}

TEST_CASE("keys with thousands of dots are refused, not followed into the depth") {
  const std::string key = repeated("a.", 200000) + "a";
  for (const std::string& text :
       {key + " = 1\n", "[" + key + "]\n", "[[" + key + "]]\n", "x = { " + key + " = 1 }\n"}) {
    const Outcome outcome = run_on("solve", text);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.starts_with("moreau: "));
  }
}

TEST_CASE("a file that is not UTF-8 is refused with a word about it") {
  for (const std::string& text : {point_on_floor({{1, "title = \"\xff\"\n[system]"}}),
                                  "# caf\xe9\n" + point_on_floor(), std::string("\xff\xfe[\0s\0", 6)}) {
    const Outcome outcome = run_on("solve", text);
    CHECK(outcome.code == 2);
    CHECK((outcome.err.find("UTF-8") != std::string::npos || outcome.err.find("utf-8") != std::string::npos));
  }
}

TEST_CASE("a byte order mark and carriage returns change nothing") {
  std::string text;
  for (const char c : point_on_floor()) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(run_on("solve", "\xef\xbb\xbf" + text).code == 0);
}

TEST_CASE("a directory, a missing file, an empty file and one without permission are refused as such") {
  const Folder folder;
  const Outcome directory = run({"solve", folder.path("")});
  CHECK(directory.code == 2);
  CHECK(directory.err.find("directory") != std::string::npos);
  const Outcome missing = run({"solve", folder.path("missing.toml")});
  CHECK(missing.code == 2);
  CHECK(missing.err.find("no such file") != std::string::npos);
  const Outcome beyond_a_file = run({"solve", folder.write("file", "") + "/problem.toml"});
  CHECK(beyond_a_file.code == 2);
  expect_refusal({"", "1:1", {"[system]"}});
  expect_refusal({"# nothing but a comment", "1:1", {"[system]"}});
}

TEST_CASE("families and sums that are too large are refused before they fill the memory") {
  constexpr int megabytes = 500;
  const auto refused = [](const std::string& text) {
    const Folder folder;
    const Outcome outcome = run_within(megabytes, {"solve", folder.write("problem.toml", text)});
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("1e7") != std::string::npos);
  };
  for (const std::string family : {"z[1..20000000]", "z[1..10000,1..10000]", "z[-9e15..9e15]", "z[1..2^53]"})
    refused(point_on_floor({{2, "coordinates = [\"x\", \"y\", \"" + family + "\"]"}}));
  for (const std::string V : {"sum(i in 1..20000000, y)", "sum(i in 1..10000, sum(j in 1..10000, i*j*y))",
                              "sum(i in 1..9e15, y)", "sum(i in 1..1e7, j in 1..i, 1)"})
    refused(potential(V));
}

TEST_CASE("an answer that standard output does not take is told, and is no success") {
  const Outcome outcome = run_by_shell("\"$0\" \"$@\" > /dev/full", {"functions"});
  CHECK(outcome.code == 2);
  CHECK(outcome.err.find("standard output") != std::string::npos);
}

TEST_CASE("a file whose name is no UTF-8 has its answer in JSON that is") {
  const Folder folder;
  const std::string bad = folder.write("\xff\xc0\xaf \xe2\x82\xac \xed\xa0\x80.toml", point_on_floor({}));
  const Outcome outcome = run({"solve", "--json", bad});
  CHECK(outcome.code == 0);
  const auto json = nlohmann::json::parse(outcome.out);  // throws where a byte is no UTF-8
  CHECK(json["file"].get<std::string>().ends_with("\ufffd\ufffd\ufffd € \ufffd\ufffd\ufffd.toml"));
}
