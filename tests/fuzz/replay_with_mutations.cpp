#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

// Where there is no libFuzzer: feeds its entry point a folder of files and mutations of them.
//   problem_file_fuzzer DICTIONARY FOLDER
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

constexpr int mutations_of_all = 4000;
constexpr int mutations_of_one = 6;  // at most, one after another
constexpr std::chrono::seconds longest{15};
constexpr const char* input_at_fault = "crash-input.toml";

using Random = std::mt19937;

std::string bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The words in quotation marks, one a line, their escapes undone where they are a letter's.
std::vector<std::string> words(const std::filesystem::path& dictionary) {
  std::ifstream file(dictionary);
  std::vector<std::string> found;
  for (std::string line; std::getline(file, line);) {
    if (line.size() < 2 || line.front() != '"') continue;
    std::string word;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      if (line[i] == '\\' && i + 2 < line.size()) ++i;
      word += line[i];
    }
    found.push_back(word);
  }
  return found;
}

std::size_t below(std::size_t bound, Random& random) { return bound == 0 ? 0 : random() % bound; }

void mutate(std::string& text, const std::vector<std::string>& seeds,
            const std::vector<std::string>& dictionary, Random& random) {
  const std::size_t at = below(text.size() + 1, random), length = below(text.size() - at + 1, random) % 40;
  switch (random() % 6) {
    case 0:
      text.erase(at, length);
      break;
    case 1:
      text.insert(at, 1, static_cast<char>(random() % 256));
      break;
    case 2:
      if (at < text.size()) text[at] = static_cast<char>(random() % 256);
      break;
    case 3:
      text.replace(at, length, dictionary[below(dictionary.size(), random)]);
      break;
    case 4:
      text.insert(below(text.size() + 1, random), text.substr(at, length));
      break;
    default: {
      const std::string& other = seeds[below(seeds.size(), random)];
      text.replace(at, length, other.substr(below(other.size(), random), 40));
    }
  }
}

bool survives(const std::string& text) {
  std::ofstream(input_at_fault, std::ios::binary) << text;  // left there when the next line does not return
  try {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    return true;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", input_at_fault, error.what());
    return false;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return EXIT_FAILURE;
  const std::vector<std::string> dictionary = words(argv[1]);
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(argv[2]))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> seeds;
  for (const auto& path : paths) seeds.push_back(bytes(path));
  if (seeds.empty() || dictionary.empty()) return EXIT_FAILURE;
  for (const std::string& seed : seeds)
    if (!survives(seed)) return EXIT_FAILURE;
  Random random(1966);
  const auto start = std::chrono::steady_clock::now();
  for (int run = 0; run < mutations_of_all && std::chrono::steady_clock::now() - start < longest; ++run) {
    std::string text = seeds[below(seeds.size(), random)];
    for (std::size_t k = 1 + below(mutations_of_one, random); k > 0; --k)
      mutate(text, seeds, dictionary, random);
    if (!survives(text)) return EXIT_FAILURE;
  }
  std::filesystem::remove(input_at_fault);
  return EXIT_SUCCESS;
}
