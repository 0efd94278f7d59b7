#pragma once

#include <string>

#include "cli/problem_file/toml_document.hpp"
#include "convex/metric.hpp"

namespace cli::inline problem_files {

/// What the reader of a metric has to know, to read it and to speak of it: the table and the key that hold
/// it, where its matrix file is looked for, its number of rows and where that comes from ("one per entry of
/// z").
struct MetricKey {
  std::string table, key, directory;
  convex::Index n;
  std::string why;
};

/// A metric as rows, { diagonal = […] } or { matrix_market = "W.mtx" }. Throws InvalidInput with the place,
/// also when the matrix is not symmetric positive definite.
convex::Metric read_metric(const TomlValue& value, const MetricKey& key);

/// A matrix from the file that `file` names. rows and columns are those that it must have, rows -1 for any.
convex::SparseMatrix read_matrix_file(const TomlValue& file, const std::string& where,
                                      const std::string& directory, convex::Index rows,
                                      convex::Index columns);

/// The path of a matrix file that a problem file in `directory` names.
std::string matrix_file(const TomlValue& file, const std::string& where, const std::string& directory);

/// What `Metric` has against a matrix, in the words of the one who gave it: it is called A there, and is an
/// inertia.
std::string metric_message(const std::string& message, const std::string& where);

}  // namespace cli::inline problem_files
