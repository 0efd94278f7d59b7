#pragma once

#include <string>

#include "cli/problem_file/toml_document.hpp"
#include "convex/exact/fraction.hpp"
#include "convex/vector.hpp"

namespace cli::inline problem_files {

/// The value as a list; otherwise InvalidInput.
const TomlValue& require_array(const TomlValue& value, const std::string& where);

/// How many entries a list has; -1 where it is none.
convex::Index entries_of(const TomlValue* list);
/// The same of a vector: -1 also where it is a list of lists.
convex::Index length_of(const TomlValue* vector);

/// A list of numbers, each rounded to the nearest double. Throws InvalidInput naming all entries that are
/// wrong.
convex::Vector read_vector(const TomlValue& value, const std::string& where);

/// Refuses what is no list of lists, saying how `where` is written; `other` is another form that it may have.
void require_rows(const TomlValue& value, const std::string& where, const std::string& other);

/// A list of rows of `columns` numbers each, of as many as the first has where that is -1. `why` says in a
/// message where that number comes from, such as "one per coordinate (z has 3)".
convex::RowMatrix read_matrix(const TomlValue& value, const std::string& where, convex::Index columns,
                              const std::string& why);

/// The same at their exact values: "1/3" is a third, a whole number itself, 0.1 the double nearest to it. A
/// string beyond all doubles, or nearer to 0 than all but 0, is refused.
convex::Fraction read_exact_number(const TomlValue& value, const std::string& where);
convex::ExactVector read_exact_vector(const TomlValue& value, const std::string& where);
convex::ExactRows read_exact_matrix(const TomlValue& value, const std::string& where, convex::Index columns,
                                    const std::string& why);

}  // namespace cli::inline problem_files
