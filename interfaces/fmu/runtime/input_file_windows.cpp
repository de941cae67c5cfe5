// core/files/input_file.cpp of Windows, which has no file descriptors of POSIX.
#include <fstream>
#include <sstream>

#include "bentaxis/files/input_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& why) {
  throw InputError(file.string() + ": " + why);
}

}  // namespace

std::string read_input_file(const std::filesystem::path& file, const InputKind& kind) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    fail(file, "is a directory, not " + std::string(kind.name));
  if (!std::filesystem::is_regular_file(file, ignored))
    fail(file, "cannot be read: no such file, or no permission");
  const auto size = std::filesystem::file_size(file, ignored);
  if (ignored || size > kind.largest)
    fail(file, std::string(kind.name) + " must have at most " +
                   rounded_text(static_cast<double>(kind.largest) / kMebibyte, 4) + " MiB");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  if (!in.is_open() || in.bad()) fail(file, "cannot be read: no such file, or no permission");
  return content.str();
}

std::optional<std::string> read_input_file_if_there(const std::filesystem::path& file,
                                                    const InputKind& kind) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  return read_input_file(file, kind);
}

}  // namespace bentaxis
