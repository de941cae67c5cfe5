// Runs a committed corpus and seeded mutations of it through a reader: a fuzzer without a compiler
// of its own, the same every time.
//   fuzz_replay KIND FOLDER MUTATIONS    kinds: as the folders of the corpus
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "readers.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// One to four changes: a byte replaced, a piece left out, doubled, or taken from another file.
Bytes mutated(Bytes bytes, const std::vector<Bytes>& corpus, std::mt19937& engine) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : engine() % n; };
  static const std::vector<std::string> words = {"nan", "inf",  "-",    "1e309", "1e-320", "0",
                                                 "99",  "\"\"", "[",    "]",     "=",      "#",
                                                 "\n",  ",",    "true", "\xff",  "\t",     "1_0"};
  for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
    const std::size_t at = below(bytes.size() + 1);
    const std::size_t length = std::min(bytes.size() - at, below(32));
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto end = place + static_cast<std::ptrdiff_t>(length);
    switch (below(5)) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<std::uint8_t>(engine());
        break;
      case 1:
        bytes.erase(place, end);
        break;
      case 2: {
        const Bytes piece(place, end);
        bytes.insert(place, piece.begin(), piece.end());
        break;
      }
      case 3: {
        const std::string& word = words[below(words.size())];
        bytes.insert(place, word.begin(), word.end());
        break;
      }
      default: {
        const Bytes& other = corpus[below(corpus.size())];
        const std::size_t from = below(other.size() + 1);
        const std::size_t count = std::min(other.size() - from, below(64));
        bytes.insert(place, other.begin() + static_cast<std::ptrdiff_t>(from),
                     other.begin() + static_cast<std::ptrdiff_t>(from + count));
      }
    }
  }
  return bytes;
}

// What is being read, for whoever has to find out why it ended the program.
const Bytes* current = nullptr;

void keep_input(int) {
  if (current != nullptr)
    std::ofstream("failing_input", std::ios::binary)
        .write(reinterpret_cast<const char*>(current->data()),
               static_cast<std::streamsize>(current->size()));
  std::fprintf(stderr, "fuzz_replay: the input is in failing_input\n");
  std::_Exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  using Reader = void (*)(const std::uint8_t*, std::size_t);
  const std::map<std::string, Reader> readers = {
#ifdef BENTAXIS_FUZZ_DESIGNS
      {"block", bentaxis::fuzz::read_as_block},
      {"study", bentaxis::fuzz::read_as_study},
      {"data", bentaxis::fuzz::read_as_data}
#else
      {"case", bentaxis::fuzz::read_as_case},   {"csv", bentaxis::fuzz::read_as_csv},
      {"curve", bentaxis::fuzz::read_as_curve}, {"drive", bentaxis::fuzz::read_as_drive},
      {"set", bentaxis::fuzz::read_as_change},  {"states", bentaxis::fuzz::read_as_states},
      {"mat", bentaxis::fuzz::read_as_matlab},  {"xlsx", bentaxis::fuzz::read_as_workbook},
      {"fmu", bentaxis::fuzz::read_as_fmu}
#endif
  };
  if (argc != 4 || readers.count(argv[1]) == 0) {
    std::string kinds;
    for (const auto& [kind, reader] : readers) kinds += (kinds.empty() ? "" : "|") + kind;
    std::fprintf(stderr, "usage: fuzz_replay %s FOLDER MUTATIONS\n", kinds.c_str());
    return 2;
  }
  const Reader read = readers.at(argv[1]);
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[2]))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Bytes> corpus;
  for (const auto& file : files) {
    corpus.push_back(bytes_of(file));
    std::printf("%s\n", file.filename().c_str());
    std::fflush(stdout);  // names the file that ends the run
    read(corpus.back().data(), corpus.back().size());
  }
  if (corpus.empty()) {
    std::fprintf(stderr, "fuzz_replay: %s is empty\n", argv[2]);
    return 2;
  }
  std::signal(SIGABRT, keep_input);
  std::mt19937 engine(1);
  const int mutations = std::stoi(argv[3]);
  for (int i = 0; i < mutations; ++i) {
    const Bytes bytes = mutated(corpus[engine() % corpus.size()], corpus, engine);
    current = &bytes;
    read(bytes.data(), bytes.size());
  }
  std::printf("%zu files, %d mutations\n", corpus.size(), mutations);
  return 0;
}
