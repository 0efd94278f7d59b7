#include <algorithm>
#include <cmath>

#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/keys.hpp"

namespace cli::inline problem_files {
namespace {

using Kind = TomlValue::Kind;

std::string quoted_toml(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    constexpr const char* hexadecimal = "0123456789ABCDEF";
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20U || byte == 0x7FU) {
      out += "\\u00";
      out += hexadecimal[byte >> 4U];
      out += hexadecimal[byte & 15U];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string toml_key(const std::string& key) {
  const bool is_bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return is_bare ? key : quoted_toml(key);
}

/// JSON has numbers that TOML has not: 1E5 is one, 1.e5 and 01 are none of both, and its integers have any
/// length, TOML's 64 bits.
std::string toml_number(const TomlValue& value) {
  if (value.kind == Kind::integer && std::abs(value.number) >= 0x1p63) return quoted_toml(value.text);
  if (std::isfinite(value.number)) return value.text;
  return std::isnan(value.number) ? "nan" : value.number > 0 ? "inf" : "-inf";
}

void write_inline(const TomlValue& value, std::string& out) {
  switch (value.kind) {
    case Kind::boolean:
      out += value.boolean ? "true" : "false";
      return;
    case Kind::integer:
    case Kind::floating:
      out += toml_number(value);
      return;
    case Kind::string:
      out += quoted_toml(value.text);
      return;
    case Kind::array: {
      const bool of_rows = !value.array.empty() && value.array.front().kind == Kind::array;
      out += '[';
      for (std::size_t i = 0; i < value.array.size(); ++i) {
        if (i > 0) out += of_rows ? ",\n  " : ", ";
        write_inline(value.array[i], out);
      }
      out += ']';
      return;
    }
    case Kind::table:
      out += '{';
      for (std::size_t i = 0; i < value.table.size(); ++i) {
        out += (i > 0 ? ", " : " ") + toml_key(value.table[i].key) + " = ";
        write_inline(value.table[i].value, out);
      }
      out += value.table.empty() ? "}" : " }";
      return;
    default:
      throw convex::InvalidInput("a date or time has no place in a problem file; take it out", value.place);
  }
}

/// Plain keys first, then the tables below.
void write_table(const TomlValue& table, const std::string& path, int depth, std::string& out) {
  constexpr int deepest_header = 2;
  const auto has_header = [&](const TomlValue& value) {
    return value.kind == Kind::table && depth < deepest_header && !value.table.empty();
  };
  for (const TomlEntry& entry : table.table) {
    if (has_header(entry.value)) continue;
    out += toml_key(entry.key) + " = ";
    write_inline(entry.value, out);
    out += '\n';
  }
  for (const TomlEntry& entry : table.table) {
    if (!has_header(entry.value)) continue;
    const std::string header = path + toml_key(entry.key);
    const bool only_tables =
        std::all_of(entry.value.table.begin(), entry.value.table.end(), [&](const TomlEntry& inner) {
          return inner.value.kind == Kind::table && depth + 1 < deepest_header && !inner.value.table.empty();
        });
    if (!only_tables) out += (out.empty() ? "[" : "\n[") + header + "]\n";
    write_table(entry.value, header + ".", depth + 1, out);
  }
}

}  // namespace

std::string toml_text(const TomlValue& document) {
  std::string out;
  write_table(document, "", 0, out);
  return out;
}

}  // namespace cli::inline problem_files
