#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <regex>
#include <string>
#include <vector>

namespace tests {

/// A text of an SVG file as gnuplot writes it, with the box that it fills at most, in pixels from the upper
/// left corner.
struct SvgText {
  std::string text;
  double left = 0, top = 0, right = 0, bottom = 0;
};

inline std::string plain_svg(std::string text) {
  text = std::regex_replace(text, std::regex("<[^>]*>"), "");
  for (const auto& [from, to] :
       {std::pair<const char*, const char*>{"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}})
    text = std::regex_replace(text, std::regex(from), to);
  const std::size_t first = text.find_first_not_of(" \n\t"), last = text.find_last_not_of(" \n\t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// All texts. Letters are taken to be 0.5 em wide on average and 0.7 em high.
inline std::vector<SvgText> svg_texts(const std::string& svg) {
  const std::regex group(
      R"re(<g transform="translate\(([-0-9.]+),([-0-9.]+)\)(?: rotate\(([-0-9.]+)\))?"[^>]*font-size="([0-9.]+)"\s+text-anchor="(\w+)">\s*<text>(.*?)</text>)re");
  std::vector<SvgText> found;
  for (std::sregex_iterator it(svg.begin(), svg.end(), group), end; it != end; ++it) {
    const std::string text = plain_svg((*it)[6].str());
    if (text.empty()) continue;
    const double x = std::stod((*it)[1]), y = std::stod((*it)[2]), size = std::stod((*it)[4]);
    const double turn = (*it)[3].matched ? std::stod((*it)[3]) * std::numbers::pi / 180 : 0;
    double letters = 0;
    for (const char c : text) letters += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
    const double width = 0.5 * size * letters, height = 0.7 * size;
    const std::string anchor = (*it)[5].str();
    const double from = anchor == "start" ? 0 : anchor == "end" ? -width : -width / 2;
    SvgText made{text, 1e300, 1e300, -1e300, -1e300};
    for (const double along : {from, from + width})
      for (const double up : {0.0, height}) {
        const double px = x + along * std::cos(turn) + up * std::sin(turn),
                     py = y + along * std::sin(turn) - up * std::cos(turn);
        made.left = std::min(made.left, px);
        made.right = std::max(made.right, px);
        made.top = std::min(made.top, py);
        made.bottom = std::max(made.bottom, py);
      }
    found.push_back(made);
  }
  return found;
}

/// No two texts lie on each other, none leaves the page. Texts that stand aslant are left out of the first:
/// their boxes are larger than they.
inline void check_legible(const std::string& svg, double slant_room = 0) {
  std::smatch box;
  REQUIRE(std::regex_search(svg, box, std::regex(R"re(viewBox="0 0 ([0-9.]+) ([0-9.]+)")re")));
  const double width = std::stod(box[1]), height = std::stod(box[2]);
  const std::vector<SvgText> texts = svg_texts(svg);
  CHECK(texts.size() >= 4);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const SvgText& a = texts[i];
    CAPTURE(a.text);
    CHECK(a.left >= -slant_room);
    CHECK(a.top >= -slant_room);
    CHECK(a.right <= width + slant_room);
    CHECK(a.bottom <= height + slant_room);
    for (std::size_t j = i + 1; j < texts.size(); ++j) {
      const SvgText& b = texts[j];
      const bool apart = a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
      CAPTURE(b.text);
      CHECK(apart);
    }
  }
}

}  // namespace tests
