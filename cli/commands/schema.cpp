#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include "cli/commands/command_line.hpp"

namespace cli::inline commands {
namespace {

/// JSON Schema 2020-12 of a problem file, whether it is TOML or JSON. It knows keys and kinds of values; what
/// expressions say is checked when a file is read.
constexpr const char* schema_of_problem_files = R"({
  "$schema": "https://json-schema.org/draft/2020-12/schema",
  "title": "A problem file of moreau",
  "type": "object",
  "additionalProperties": false,
  "oneOf": [
    {"required": ["system", "state"]}, {"required": ["projection"]}, {"required": ["decomposition"]},
    {"required": ["cone"]}, {"required": ["liquid"]}
  ],
  "$defs": {
    "expression": {"type": ["string", "number"]},
    "expressions": {"type": "object", "additionalProperties": {"$ref": "#/$defs/expression"}},
    "number": {"type": ["number", "string"]},
    "vector": {"type": "array", "items": {"$ref": "#/$defs/number"}},
    "rows": {"type": "array", "items": {"$ref": "#/$defs/vector"}},
    "names": {"anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}]},
    "file": {
      "type": "object", "required": ["matrix_market"], "additionalProperties": false,
      "properties": {"matrix_market": {"type": "string"}}
    },
    "diagonal": {
      "type": "object", "required": ["diagonal"], "additionalProperties": false,
      "properties": {"diagonal": {"$ref": "#/$defs/vector"}}
    },
    "metric": {"anyOf": [{"$ref": "#/$defs/rows"}, {"$ref": "#/$defs/diagonal"}, {"$ref": "#/$defs/file"}]},
    "by_constraint": {
      "anyOf": [{"$ref": "#/$defs/number"},
                {"type": "object", "additionalProperties": {"$ref": "#/$defs/number"}}]
    }
  },
  "if": {"required": ["system"], "not": {"required": ["bodies"]}},
  "then": {"properties": {"system": {"required": ["coordinates", "kinetic"]}}},
  "properties": {
    "title": {"type": "string"},
    "system": {
      "type": "object", "additionalProperties": false,
      "properties": {
        "coordinates": {"type": "array", "items": {"type": "string"}},
        "kinetic": {"$ref": "#/$defs/expression"},
        "potential": {"$ref": "#/$defs/expression"},
        "parameters": {"$ref": "#/$defs/expressions"},
        "definitions": {"$ref": "#/$defs/expressions"},
        "forces": {"$ref": "#/$defs/expressions"},
        "constraints": {"type": "object", "additionalProperties": {"type": "string"}},
        "looseness": {
          "type": "object",
          "additionalProperties": {
            "type": "object", "required": ["between", "gap"], "additionalProperties": false,
            "properties": {
              "between": {"type": "array", "items": {"$ref": "#/$defs/expression"}, "minItems": 2, "maxItems": 2},
              "gap": {"$ref": "#/$defs/expression"},
              "restitution": {"$ref": "#/$defs/number"}
            }
          }
        }
      }
    },
    "bodies": {
      "type": "object",
      "additionalProperties": {
        "type": "object", "required": ["mass", "inertia"], "additionalProperties": false,
        "properties": {
          "mass": {"$ref": "#/$defs/expression"},
          "inertia": {"type": "array", "items": {"$ref": "#/$defs/expression"}, "minItems": 3, "maxItems": 3}
        }
      }
    },
    "state": {
      "type": "object", "required": ["position"], "additionalProperties": false,
      "properties": {
        "t": {"$ref": "#/$defs/expression"},
        "position": {"$ref": "#/$defs/expressions"},
        "velocity": {"$ref": "#/$defs/expressions"},
        "in_contact": {"$ref": "#/$defs/names"},
        "solve_for": {"$ref": "#/$defs/names"}
      }
    },
    "projection": {
      "type": "object", "required": ["A", "z"], "additionalProperties": false,
      "properties": {
        "A": {"$ref": "#/$defs/metric"},
        "z": {"$ref": "#/$defs/vector"},
        "U": {"anyOf": [{"$ref": "#/$defs/rows"}, {"$ref": "#/$defs/file"}]},
        "s": {"$ref": "#/$defs/vector"},
        "two_sided": {"type": "array", "items": {"type": "integer", "minimum": 0}}
      }
    },
    "decomposition": {
      "type": "object", "required": ["z", "f"], "additionalProperties": false,
      "properties": {
        "z": {"$ref": "#/$defs/vector"},
        "f": {"type": "string"},
        "metric": {"$ref": "#/$defs/metric"}
      }
    },
    "cone": {
      "type": "object", "additionalProperties": false,
      "properties": {
        "generators": {"$ref": "#/$defs/rows"},
        "lines": {"$ref": "#/$defs/rows"},
        "halfspaces": {"$ref": "#/$defs/rows"},
        "equations": {"$ref": "#/$defs/rows"},
        "z": {"$ref": "#/$defs/vector"},
        "metric": {"$ref": "#/$defs/metric"},
        "dimension": {"type": "integer", "minimum": 0}
      }
    },
    "liquid": {"type": "object", "required": ["coordinates", "domain"]},
    "draw": {"type": "object"},
    "solve": {
      "type": "object", "additionalProperties": false,
      "properties": {
        "method": {"type": "string"},
        "tolerance": {"$ref": "#/$defs/number"},
        "contact_tolerance": {"$ref": "#/$defs/by_constraint"}
      }
    },
    "simulate": {
      "type": "object",
      "properties": {
        "until": {"$ref": "#/$defs/number"},
        "method": {"enum": ["event-driven", "time-stepping", "auto"]},
        "tolerance": {"$ref": "#/$defs/number"},
        "step": {"$ref": "#/$defs/number"},
        "restitution": {"$ref": "#/$defs/by_constraint"},
        "samples": {"type": "integer", "minimum": 2},
        "impact_law": {"enum": ["moreau", "poisson", "sequential"]}
      }
    }
  }
}
)";

}  // namespace

void add_schema(CLI::App& program, Work& chosen) {
  add_command(program, "schema", "a JSON Schema of the problem file, for editors", chosen, [] {
    fmt::print("{}", schema_of_problem_files);
    return Exit::solved;
  });
}

}  // namespace cli::inline commands
