#pragma once

#include <string>
#include <variant>
#include <vector>

namespace cli::inline reports {

/// A formula, as plain Unicode text and as LaTeX without its dollars.
struct Math {
  std::string plain, latex;
};
/// A name of the problem file.
struct Name {
  std::string text;
};
/// What a sentence is made of.
using Piece = std::variant<std::string, Math, Name>;
using Line = std::vector<Piece>;

struct Heading {
  std::string text;
};
struct Paragraph {
  Line line;
};
/// A formula on a line of its own.
struct Formula {
  Math math;
};
struct Table {
  std::vector<Line> head;
  std::vector<std::vector<Line>> rows;  ///< as wide as the head
};
using Block = std::variant<Heading, Paragraph, Formula, Table>;

/// A report before it is text, Markdown, LaTeX or HTML.
struct Document {
  std::string title;
  std::vector<Block> blocks;
};

/// For the screen: paragraphs broken at 100 characters.
std::string document_text(const Document&);
/// With formulas between dollars, as GitHub and pandoc read them.
std::string document_markdown(const Document&);
/// A whole file for pdflatex, with amsmath alone.
std::string document_latex(const Document&);
/// A whole file that needs nothing from anywhere.
std::string document_html(const Document&);

/// A number of six significant digits, in both ways of writing.
Math number_math(double x);

/// An expression of a problem file as LaTeX: "m/2*x'^2" is m/2\,\dot{x}^{2}.
std::string expression_latex(const std::string& expression);

/// Words as HTML shows them: nothing in them is markup.
std::string html_words(const std::string& words);

}  // namespace cli::inline reports
