// A locale with a decimal comma, as a desktop program or Qt sets it for the whole process.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <clocale>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <locale>
#include <string>

namespace bentaxis::test {

/// Acts while it exists, on C and on C++. Needs no locale of the machine: the file LC_NUMERIC of
/// the C library is written here.
class CommaLocale {
 public:
  CommaLocale() {
    folder_ = std::filesystem::temp_directory_path() / ("comma_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_ / "comma");
    // Identification, number of entries, their places; then the entries: "," and no separator of
    // thousands, both also as wide characters, and the character set.
    constexpr std::array<std::uint32_t, 8> kHead = {0x20031114, 6, 32, 34, 35, 36, 40, 44};
    constexpr std::array<char, 18> kEntries = {',', 0, 0, 0,   ',', 0,   0,   0,   0,
                                               0,   0, 0, 'U', 'T', 'F', '-', '8', 0};
    std::ofstream file(folder_ / "comma" / "LC_NUMERIC", std::ios::binary);
    file.write(reinterpret_cast<const char*>(kHead.data()), sizeof kHead);
    file.write(kEntries.data(), sizeof kEntries);
    file.close();
    setenv("LOCPATH", folder_.c_str(), 1);
    EXPECT_NE(std::setlocale(LC_NUMERIC, "comma"), nullptr);
    EXPECT_STREQ(std::localeconv()->decimal_point, ",");
    former_ = std::locale::global(std::locale(std::locale::classic(), new Comma));
    std::setlocale(LC_NUMERIC, "comma");
  }
  ~CommaLocale() {
    std::locale::global(former_);
    std::setlocale(LC_NUMERIC, "C");
    unsetenv("LOCPATH");
    std::filesystem::remove_all(folder_);
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

 private:
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  std::filesystem::path folder_;
  std::locale former_;
};

}  // namespace bentaxis::test
