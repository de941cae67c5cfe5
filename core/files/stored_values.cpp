#include "bentaxis/files/stored_values.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/pump/error.h"

namespace bentaxis {
namespace {

constexpr std::size_t kBytesOfBlock = StoredValues::kBlock * sizeof(double);

class NamelessFile {
 public:
  explicit NamelessFile(const std::filesystem::path& folder) {
    std::string name = (folder / ".bentaxis-values-XXXXXX").string();
    handle_ = mkostemp(name.data(), 0);
    if (handle_ >= 0) unlink(name.c_str());
  }
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;
  ~NamelessFile() {
    if (handle_ >= 0) close(handle_);
  }

  bool write_at(std::size_t place, const char* bytes, std::size_t count) const {
    return all_of(place, count, [&](std::size_t done, std::size_t left, off_t at) {
      return pwrite(handle_, bytes + done, left, at);
    });
  }
  bool read_at(std::size_t place, char* bytes, std::size_t count) const {
    return all_of(place, count, [&](std::size_t done, std::size_t left, off_t at) {
      return pread(handle_, bytes + done, left, at);
    });
  }

 private:
  template <class Move>
  static bool all_of(std::size_t place, std::size_t count, const Move& move) {
    for (std::size_t done = 0; done < count;) {
      const ssize_t moved = move(done, count - done, static_cast<off_t>(place + done));
      if (moved <= 0) return false;
      done += static_cast<std::size_t>(moved);
    }
    return true;
  }

  int handle_ = -1;
};

// In the file block after block of rows, in each of them column after column. Each thread has the
// blocks in its memory that it has read last, about one for each column.
class InFile : public StoredValues {
 public:
  InFile(std::unique_ptr<const NamelessFile> file, std::size_t columns)
      : file_(std::move(file)), columns_(columns) {}

 private:
  struct Slot {
    std::size_t table = 0, number = 0, column = 0;  // table: 0 = none
    std::vector<double> values;
  };

  const double* block(std::size_t number, std::size_t column) const override {
    constexpr std::size_t kSlots = 1024, kApart = 257;  // tables that are read side by side
    thread_local std::array<Slot, kSlots> slots;
    Slot& slot = slots[(id_ * kApart + column) % kSlots];
    if (slot.table == id_ && slot.number == number && slot.column == column)
      return slot.values.data();
    slot.table = 0;
    slot.values.resize(kBlock);
    if (!file_->read_at((number * columns_ + column) * kBytesOfBlock,
                        reinterpret_cast<char*>(slot.values.data()), kBytesOfBlock))
      throw ComputationError("values that were kept in a file could not be read back");
    slot.table = id_;
    slot.number = number;
    slot.column = column;
    return slot.values.data();
  }

  static std::size_t next_id() {
    static std::atomic<std::size_t> last = 0;
    return ++last;
  }

  std::unique_ptr<const NamelessFile> file_;
  std::size_t columns_, id_ = next_id();
};

// Rows from `first` on, column by column; what the last block lacks is 0.
std::vector<double> block_of(const ResultTable& table, std::size_t first) {
  std::vector<double> block(StoredValues::kBlock * table.columns());
  const std::size_t rows = std::min(StoredValues::kBlock, table.rows() - first);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < table.columns(); ++column)
      block[column * StoredValues::kBlock + row] = table.at(first + row, column);
  return block;
}

}  // namespace

bool store_values(ResultTable& table, const std::filesystem::path& folder) {
  if (table.stored || table.values.empty()) return false;
  auto file = std::make_unique<NamelessFile>(folder);
  std::size_t place = 0;
  for (std::size_t first = 0; first < table.rows(); first += StoredValues::kBlock) {
    const std::vector<double> block = block_of(table, first);
    const std::size_t bytes = block.size() * sizeof(double);
    if (!file->write_at(place, reinterpret_cast<const char*>(block.data()), bytes)) return false;
    place += bytes;
  }
  table.stored = std::make_shared<InFile>(std::move(file), table.columns());
  std::vector<double>().swap(table.values);  // with its room
  return true;
}

}  // namespace bentaxis
