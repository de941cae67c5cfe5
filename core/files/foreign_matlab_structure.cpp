// Whether a MATLAB file is whole: every element inside the one that holds it, as many values as its
// dimensions say, nothing missing at the end. The library that reads the values fills what is
// missing with whatever fits.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>

#include "bentaxis/files/input_file.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "foreign_grid.h"

namespace bentaxis::foreign {
namespace {

// Of everything that is compressed in a file.
constexpr std::uint64_t kLargestUnpacked = 1024 * kMebibyte;
// Structures and cells below each other.
constexpr int kDeepest = 16;

// What a value is stored as (MAT-file format, table 1-1), and what a variable is (table 1-3).
enum Type : std::uint32_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt32 = 5,
  kUint32 = 6,
  kMatrix = 14,
  kCompressed = 15
};
enum Class : std::uint32_t {
  kCell = 1,
  kStruct = 2,
  kObject = 3,
  kChar = 4,
  kSparse = 5,
  kFirstNumeric = 6,
  kLastNumeric = 15
};

// Bytes of a value of a type; 0: no type of a value.
std::uint64_t size_of(std::uint32_t type) {
  constexpr std::array<std::uint64_t, 19> kSizes = {0, 1, 1, 2, 2, 4, 4, 4, 0, 8,
                                                    0, 0, 8, 8, 0, 0, 1, 2, 4};
  return type < kSizes.size() ? kSizes[type] : 0;
}

struct Damage {
  std::string why;
};

[[noreturn]] void damaged(const std::string& why) { throw Damage{why}; }
[[noreturn]] void truncated(const std::string& what, std::uint64_t needed, std::uint64_t there) {
  damaged("is a truncated MATLAB file: " + what + " takes " + std::to_string(needed) + " bytes, " +
          std::to_string(there) + " are there");
}

std::uint32_t word_at(std::string_view bytes, std::size_t at, bool swapped) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return swapped ? __builtin_bswap32(word) : word;
}

// A product that stays at the largest number where it would be larger.
std::uint64_t times(std::uint64_t a, std::uint64_t b) {
  std::uint64_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? std::numeric_limits<std::uint64_t>::max()
                                                : product;
}

// ---- Version 5 to 7.2

struct Element {
  std::uint32_t type = 0;
  std::string_view data;
};

class Elements {
 public:
  Elements(std::string_view bytes, bool swapped, bool outermost)
      : bytes_(bytes), swapped_(swapped), outermost_(outermost) {}

  bool at_end() const { return bytes_.empty(); }

  Element next(const std::string& what) {
    constexpr std::size_t kTag = 8;
    if (bytes_.size() < kTag) truncated(what, kTag, bytes_.size());
    const std::uint32_t first = word_at(bytes_, 0, swapped_);
    if (const std::uint32_t small = first >> 16U; small > 0) {  // with its values in its tag
      if (small > 4) damaged("has a small element of " + std::to_string(small) + " bytes");
      const Element element{first & 0xFFFFU, bytes_.substr(4, small)};
      bytes_.remove_prefix(kTag);
      return element;
    }
    const std::uint64_t size = word_at(bytes_, 4, swapped_);
    if (size > bytes_.size() - kTag) truncated(what, size, bytes_.size() - kTag);
    const Element element{first, bytes_.substr(kTag, size)};
    bytes_.remove_prefix(kTag + size);
    // Elements begin at multiples of 8 bytes; what is compressed ends where it ends.
    const std::size_t padding = first == kCompressed ? 0 : (8 - size % 8) % 8;
    if (padding > bytes_.size() && outermost_)
      truncated(what, size + padding, size + bytes_.size());
    bytes_.remove_prefix(std::min(padding, bytes_.size()));
    return element;
  }

 private:
  std::string_view bytes_;
  bool swapped_, outermost_;
};

class Version5 {
 public:
  Version5(std::string_view content, bool swapped) : swapped_(swapped), content_(content) {}

  void check() {
    constexpr std::size_t kHeader = 128;
    Elements elements(content_.substr(kHeader), swapped_, true);
    for (int variable = 1; !elements.at_end(); ++variable) {
      const std::string what = "variable " + std::to_string(variable);
      const Element element = elements.next(what);
      if (element.type == kMatrix) {
        check_matrix(element.data, what, 0);
      } else if (element.type == kCompressed) {
        const std::string plain = inflated(element.data, what);
        Elements inner(plain, swapped_, false);
        const Element only = inner.next(what);
        if (only.type != kMatrix || !inner.at_end())
          damaged("is a damaged MATLAB file: " + what + " is compressed and holds no variable");
        check_matrix(only.data, what, 0);
      } else {
        damaged("is a damaged MATLAB file: " + what + " is of no known kind (" +
                std::to_string(element.type) + ")");
      }
    }
  }

 private:
  std::string inflated(std::string_view bytes, const std::string& what) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
    const std::unique_ptr<z_stream, int (*)(z_stream*)> ends(&stream, inflateEnd);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    std::string out;
    std::array<char, 1U << 16U> piece;
    for (;;) {
      stream.next_out = reinterpret_cast<Bytef*>(piece.data());
      stream.avail_out = piece.size();
      const int state = inflate(&stream, Z_NO_FLUSH);
      const std::size_t count = piece.size() - stream.avail_out;
      unpacked_ += count;
      if (unpacked_ > kLargestUnpacked)
        damaged("is larger than " + std::to_string(kLargestUnpacked / kMebibyte) +
                " MiB when unpacked");
      out.append(piece.data(), count);
      if (state == Z_STREAM_END) return out;
      if (state != Z_OK || (count == 0 && stream.avail_in == 0))
        damaged("is a damaged MATLAB file: " + what + " cannot be unpacked");
    }
  }

  // The values of an element; they must be of a type, and as many.
  void check_values(const Element& element, std::uint64_t count, const std::string& what) const {
    const std::uint64_t size = size_of(element.type);
    if (size == 0)
      damaged("is a damaged MATLAB file: the values of " + what + " are of no known type (" +
              std::to_string(element.type) + ")");
    if (const std::uint64_t needed = times(count, size); element.data.size() < needed)
      truncated(what, needed, element.data.size());
  }

  void check_matrix(std::string_view bytes, const std::string& what, int depth) {
    if (depth > kDeepest)
      damaged("has structures or cells more than " + std::to_string(kDeepest) +
              " deep in each other");
    if (bytes.empty()) return;  // an empty cell
    Elements parts(bytes, swapped_, false);
    const Element flags = parts.next(what);
    if (flags.type != kUint32 || flags.data.size() != 8)
      damaged("is a damaged MATLAB file: " + what + " does not say what it is");
    const std::uint32_t word = word_at(flags.data, 0, swapped_);
    const std::uint32_t kind = word & 0xFFU;
    const bool complex = (word & 0x800U) != 0;
    if (kind > kLastNumeric) return;  // functions and objects, which are not read
    const Element dimensions = parts.next(what);
    if (dimensions.type != kInt32 || dimensions.data.size() < 8 ||
        dimensions.data.size() % 4 != 0 || dimensions.data.size() > 32 * 4)
      damaged("is a damaged MATLAB file: " + what + " has no dimensions");
    std::uint64_t count = 1;
    for (std::size_t i = 0; i < dimensions.data.size(); i += 4) {
      const std::uint32_t size = word_at(dimensions.data, i, swapped_);
      if (size > static_cast<std::uint32_t>(std::numeric_limits<std::int32_t>::max()))
        damaged("is a damaged MATLAB file: " + what + " has a negative dimension");
      count = times(count, size);
    }
    const Element name = parts.next(what);
    if (name.type != kInt8 && name.type != kUint8)
      damaged("is a damaged MATLAB file: " + what + " has no name");
    const std::string called =
        name.data.empty() ? what : "\"" + without_control_characters(std::string(name.data)) + "\"";
    if (kind >= kFirstNumeric || kind == kChar) {
      for (int part = 0; part < (complex && kind != kChar ? 2 : 1); ++part)
        if (count > 0 || !parts.at_end()) check_values(parts.next(called), count, called);
    } else if (kind == kCell) {
      check_below(parts, count, called, depth);
    } else if (kind == kStruct || kind == kObject) {
      if (kind == kObject) parts.next(called);  // the name of its class
      const Element length = parts.next(called);
      const Element names = parts.next(called);
      if (length.type != kInt32 || length.data.size() != 4 || names.type != kInt8)
        damaged("is a damaged MATLAB file: " + called + " has no names of its fields");
      const std::uint32_t one = word_at(length.data, 0, swapped_);
      if (one == 0 || one > names.data.size() + 1 || names.data.size() % one != 0)
        damaged("is a damaged MATLAB file: the names of the fields of " + called +
                " are not of one length");
      for (std::size_t at = 0; at < names.data.size(); at += one)
        if (names.data.substr(at, one).find('\0') == std::string_view::npos)
          damaged("is a damaged MATLAB file: a name of a field of " + called + " has no end");
      check_below(parts, times(count, names.data.size() / one), called, depth);
    } else if (kind == kSparse) {
      damaged("holds the sparse matrix " + called + ": save it as full(..)");
    } else {
      damaged("is a damaged MATLAB file: " + called + " is of no known class (" +
              std::to_string(kind) + ")");
    }
    if (!parts.at_end())
      damaged("is a damaged MATLAB file: " + called + " is longer than its values");
  }

  void check_below(Elements& parts, std::uint64_t count, const std::string& what, int depth) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const Element element = parts.next(what);
      if (element.type != kMatrix)
        damaged("is a damaged MATLAB file: " + what + " holds something that is not a variable");
      check_matrix(element.data, what, depth + 1);
    }
  }

  bool swapped_;
  std::string_view content_;
  std::uint64_t unpacked_ = 0;
};

// ---- Version 4

void check_version_4(std::string_view content) {
  constexpr std::size_t kHeader = 20;
  std::string_view rest = content;
  for (int variable = 1; !rest.empty(); ++variable) {
    const std::string what = "variable " + std::to_string(variable);
    if (rest.size() < kHeader) truncated(what, kHeader, rest.size());
    // Its kind is MOPT, a decimal number of four digits: of the other byte order it is larger.
    const bool swapped = word_at(rest, 0, false) > 9999;
    const std::uint32_t kind = word_at(rest, 0, swapped);
    constexpr std::array<std::uint64_t, 6> kSizes = {8, 4, 4, 2, 2, 1};
    const std::uint32_t precision = kind / 10 % 10, matrix = kind % 10;
    if (kind > 9999 || kind / 1000 > 1 || kind / 100 % 10 != 0 || precision >= kSizes.size() ||
        matrix > 1)
      damaged(matrix == 2 && kind < 9999
                  ? "holds a sparse matrix: save it as full(..)"
                  : "is not a MATLAB file, or it is damaged: " + what + " is of no known kind");
    const std::uint64_t rows = word_at(rest, 4, swapped), columns = word_at(rest, 8, swapped);
    const std::uint64_t complex = word_at(rest, 12, swapped), name = word_at(rest, 16, swapped);
    if (complex > 1 || name == 0)
      damaged("is not a MATLAB file, or it is damaged: " + what + " has no name");
    const std::uint64_t values =
        times(times(rows, columns), kSizes[precision] * (complex == 1 ? 2 : 1));
    const std::uint64_t there = rest.size() - kHeader;
    if (name > there || values > there - name)
      truncated(what, values == std::numeric_limits<std::uint64_t>::max() ? values : name + values,
                there);
    if (rest[kHeader + name - 1] != '\0')
      damaged("is not a MATLAB file, or it is damaged: the name of " + what + " has no end");
    rest.remove_prefix(kHeader + name + values);
  }
}

// ---- Version 7.3: HDF5 behind a block of 512 bytes

void check_hdf5(std::string_view content) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  std::size_t at = 0;
  while (at + kSignature.size() <= content.size() && content.substr(at, 8) != kSignature)
    at = at == 0 ? 512 : 2 * at;
  constexpr std::size_t kLongest = 96;  // of what is looked at
  if (at + kLongest > content.size()) truncated("its beginning", at + kLongest, content.size());
  const std::string_view block = content.substr(at);
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(block[i]); };
  const unsigned version = byte(8);
  const std::size_t width = byte(version < 2 ? 13 : 9);
  if (version > 3 || (width != 2 && width != 4 && width != 8))
    damaged("is a damaged MATLAB file: it does not begin as HDF5 of a known version");
  // Base address, another one, then where the file ends.
  const std::size_t place = (version == 0 ? 24 : version == 1 ? 28 : 12) + 2 * width;
  std::uint64_t end = 0;
  for (std::size_t i = width; i-- > 0;) end = end << 8U | byte(place + i);
  if (end > content.size()) truncated("the file by its own count", end, content.size());
}

}  // namespace

void check_matlab_structure(const std::filesystem::path& file, const std::string& content) {
  const std::string_view bytes = content;
  try {
    constexpr std::size_t kVersionAt = 124, kHeader = 128;
    const bool heading = bytes.size() >= kHeader;
    const std::string_view version = heading ? bytes.substr(kVersionAt, 4) : std::string_view();
    using namespace std::string_view_literals;
    if (bytes.substr(0, 10) == "MATLAB 7.3" || bytes.substr(0, 4) == "\x89HDF" ||
        version == "\0\2IM"sv || version == "\2\0MI"sv) {
      check_hdf5(bytes);
    } else if (version == "\0\1IM"sv || version == "\1\0MI"sv) {
      Version5(bytes, version == "\1\0MI"sv).check();
    } else if (bytes.substr(0, 7) == "MATLAB ") {
      if (!heading) truncated("its heading", kHeader, bytes.size());
      damaged("is not a MATLAB file, or it is damaged");
    } else {
      check_version_4(bytes);
    }
  } catch (const Damage& damage) {
    throw InputError(file.string() + ": " + damage.why);
  }
}

}  // namespace bentaxis::foreign
