#pragma once

#include <initializer_list>

#include "cli/problem_file/toml_document.hpp"

namespace cli::inline problem_files {

inline constexpr std::initializer_list<const char*> system_keys{
    "coordinates", "kinetic", "potential", "parameters", "definitions", "forces", "constraints", "looseness"};
inline constexpr std::initializer_list<const char*> projection_keys{"A", "z", "U", "s", "two_sided"};
inline constexpr std::initializer_list<const char*> decomposition_keys{"z", "f", "metric"};
inline constexpr std::initializer_list<const char*> cone_keys{
    "generators", "lines", "halfspaces", "equations", "z", "metric", "dimension"};
inline constexpr std::initializer_list<const char*> liquid_keys{
    "coordinates", "domain", "density", "velocity", "force",    "free",
    "walls",       "cells",  "low",     "high",     "symmetry", "parameters"};

/// What may stand at the top of a problem file.
inline constexpr std::initializer_list<const char*> top_keys{
    "title",  "system", "state",    "projection", "decomposition", "cone",
    "liquid", "solve",  "simulate", "draw",       "bodies"};

/// A table that says what a file is about, and its keys.
struct ProblemKind {
  const char* name;
  const std::initializer_list<const char*>* keys;
  bool has(const std::string& key) const;
};

inline constexpr ProblemKind problem_kinds[] = {{"system", &system_keys},
                                                {"projection", &projection_keys},
                                                {"decomposition", &decomposition_keys},
                                                {"cone", &cone_keys},
                                                {"liquid", &liquid_keys}};

/// What a document is about: the first of these tables that it has, else the one of which most of the keys at
/// its top are. Null where there is none, or more than one.
const ProblemKind* kind_of(const TomlValue& document);

}  // namespace cli::inline problem_files
