#include "mechanics/liquid/domain_text.hpp"

#include "convex/invalid_input.hpp"

namespace mechanics::liquid {
namespace {

class ShapeParsing {
 public:
  explicit ShapeParsing(const Text& text) : text_(text) {}

  ShapeText shape() {
    ShapeText made;
    made.name = name("a shape");
    expect('(');
    while (!accept(')')) {
      const std::string key = name("a key such as radius");
      expect('=');
      made.values[key] = value();
      skip();
      if (!accept(',') && !at(')')) fail("expected \",\" or \")\"");
    }
    skip();
    if (at_ != text_.text.size()) fail("something follows the shape; expected the end");
    return made;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw convex::InvalidInput("domain: " + message +
                                   "; write interval(low=0, high=1), box(low=[0, 0], high=[1, 1]), "
                                   "disc(center=[0, 0], radius=1), ball(…), "
                                   "polygon(vertices=[[0, 0], [1, 0], [0, 1]]) or \"{x^2 + y^2 <= 1}\"",
                               text_.at(at_));
  }
  void skip() {
    while (at_ < text_.text.size() &&
           (text_.text[at_] == ' ' || text_.text[at_] == '\n' || text_.text[at_] == '\t'))
      ++at_;
  }
  bool at(char c) {
    skip();
    return at_ < text_.text.size() && text_.text[at_] == c;
  }
  bool accept(char c) {
    if (!at(c)) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(std::string("expected \"") + c + "\"");
  }
  std::string name(const char* wanted) {
    skip();
    const std::size_t begin = at_;
    while (at_ < text_.text.size() &&
           ((text_.text[at_] >= 'a' && text_.text[at_] <= 'z') || text_.text[at_] == '_'))
      ++at_;
    if (begin == at_) fail(std::string("expected ") + wanted);
    return text_.text.substr(begin, at_ - begin);
  }
  ShapeText::Value value() {
    skip();
    ShapeText::Value made;
    made.text.begin = text_.at(at_);
    if (accept('[')) {
      made.is_list = true;
      while (!accept(']')) {
        made.entries.push_back(value());
        if (!accept(',') && !at(']')) fail("expected \",\" or \"]\"");
      }
      return made;
    }
    const std::size_t begin = at_;
    int depth = 0;
    for (; at_ < text_.text.size(); ++at_) {
      const char c = text_.text[at_];
      if (depth == 0 && (c == ',' || c == ')' || c == ']')) break;
      depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    }
    if (begin == at_) fail("expected a value");
    made.text.text = text_.text.substr(begin, at_ - begin);
    return made;
  }

  const Text& text_;
  std::size_t at_ = 0;
};

}  // namespace

ShapeText parse_shape(const Text& text) { return ShapeParsing(text).shape(); }

}  // namespace mechanics::liquid
