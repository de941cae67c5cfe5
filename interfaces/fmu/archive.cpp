#include "archive.h"

#include <zip.h>

#include <memory>

#include "bentaxis/pump/error.h"

namespace bentaxis::fmu {
namespace {

constexpr zip_uint16_t kFirstDay = (1 << 5) | 1;  // of a zip archive: 1980-01-01
constexpr int kCompression = 6;                   // of nine: the rest is time for nothing

[[noreturn]] void fail(const std::string& why) {
  throw ComputationError("the archive of the FMU cannot be made: " + why);
}

struct Discard {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
using Archive = std::unique_ptr<zip_t, Discard>;
struct Free {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Source = std::unique_ptr<zip_source_t, Free>;

void add(zip_t* archive, const ArchiveFile& file) {
  zip_source_t* bytes = zip_source_buffer(archive, file.bytes.data(), file.bytes.size(), 0);
  const zip_int64_t place =
      bytes == nullptr ? -1 : zip_file_add(archive, file.name.c_str(), bytes, ZIP_FL_ENC_UTF_8);
  if (place < 0) {
    zip_source_free(bytes);
    fail(zip_strerror(archive));
  }
  const auto index = static_cast<zip_uint64_t>(place);
  const zip_uint32_t rights = file.program ? 0100755 : 0100644;  // a regular file
  if (zip_set_file_compression(archive, index, ZIP_CM_DEFLATE, kCompression) != 0 ||
      zip_file_set_dostime(archive, index, 0, kFirstDay, 0) != 0 ||
      zip_file_set_external_attributes(archive, index, 0, ZIP_OPSYS_UNIX, rights << 16) != 0)
    fail(zip_strerror(archive));
}

std::string bytes_of(zip_source_t* source) {
  if (zip_source_open(source) != 0) fail(zip_error_strerror(zip_source_error(source)));
  zip_source_seek(source, 0, SEEK_END);
  std::string bytes(static_cast<std::size_t>(zip_source_tell(source)), '\0');
  zip_source_seek(source, 0, SEEK_SET);
  const zip_int64_t read = zip_source_read(source, bytes.data(), bytes.size());
  zip_source_close(source);
  if (read != static_cast<zip_int64_t>(bytes.size())) fail("it cannot be read back");
  return bytes;
}

}  // namespace

std::string zip_archive(const std::vector<ArchiveFile>& files) {
  zip_error_t error;
  zip_error_init(&error);
  const Source target(zip_source_buffer_create(nullptr, 0, 0, &error));
  if (!target) fail(zip_error_strerror(&error));
  Archive archive(zip_open_from_source(target.get(), ZIP_TRUNCATE, &error));
  if (!archive) fail(zip_error_strerror(&error));
  zip_source_keep(target.get());  // the archive gives its own hold back when it is closed
  for (const ArchiveFile& file : files) add(archive.get(), file);
  if (zip_close(archive.get()) != 0) fail(zip_strerror(archive.get()));
  static_cast<void>(archive.release());  // closed, it is gone
  return bytes_of(target.get());
}

}  // namespace bentaxis::fmu
