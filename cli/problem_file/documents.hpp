#pragma once

#include <string>

#include "cli/problem_file/toml_document.hpp"
#include "convex/nearest_point/problem.hpp"

namespace cli::inline problem_files {

/// The forms that a problem file may have, by the ending of its name; all else is TOML.
enum class DocumentForm { toml, json, qps, matrix_market };
DocumentForm form_of(const std::string& file);

/// Reads a problem file of any form (a folder of Matrix Market files, too) as the document that TOML would
/// give. Throws InvalidInput, with the place in the file.
TomlValue read_document(const std::string& file);

/// JSON as a document, its places those of the JSON text.
TomlValue parse_json(const std::string& text);

/// A quadratic program in the QPS format (Maros and Meszaros 1999) as [projection]: minimise 1/2 x.Qx + c.x
/// over linear rows with ranges and bounds; constants of the objective are left out.
TomlValue parse_qps(const std::string& text);

/// A, z, U, s and two_sided of a folder as [projection].
TomlValue read_matrix_folder(const std::string& folder);

/// The document in a form. Throws InvalidInput that names what the form cannot hold.
std::string toml_text(const TomlValue& document);
std::string json_text(const TomlValue& document);
std::string qps_text(const TomlValue& document, const std::string& name);

/// A.mtx, z.mtx, U.mtx, s.mtx and, where there are two-sided rows, two_sided.mtx in a folder, which is made.
void write_matrix_folder(const TomlValue& document, const std::string& folder);

/// Puts the numbers of matrix files, which are looked for in `directory`, in the place of their names.
void write_matrices_out(TomlValue& document, const std::string& directory);
/// Those alone that hold integers which are no doubles: a document has them exactly.
void write_long_integers_out(TomlValue& document, const std::string& directory);

/// The same of numbers.
void write_problem_folder(const convex::NearestPointProblem&, const std::string& folder);

/// The Gram matrix of a metric in full.
convex::Matrix full_gram(const convex::Metric& A);

/// Writes a text to a file, whole: Ctrl-C waits until it is there. Throws InvalidInput when it cannot.
void write_file(const std::string& file, const std::string& text);

/// A document whose one table is [projection], from numbers.
TomlValue projection_document(const std::vector<std::vector<std::string>>& A,
                              const std::vector<std::string>& z,
                              const std::vector<std::vector<std::string>>& U,
                              const std::vector<std::string>& s, const std::vector<std::size_t>& two_sided);

}  // namespace cli::inline problem_files
