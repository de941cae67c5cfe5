// Output folders whose files appear whole or not at all.
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/files/staging_folder.h"

namespace bentaxis {

/// Collects the files of a run and puts them in place as a set: each is written into a hidden
/// folder first, and only when all are complete are they renamed. On any failure nothing is left,
/// and what was there before is there again. What a killed run has left is removed by the next
/// commit(). Of two programs, or two objects of one program, that write
/// the same files, all files are those of the one that ends last.
class OutputFolder {
 public:
  /// Creates the folder where it is missing and checks that it can be written to, so that a long
  /// run does not end in a refusal.
  /// @throws InputError
  explicit OutputFolder(std::filesystem::path folder);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();

  /// Writes a file under a temporary name. @throws InputError
  void add(const std::string& name, const std::string& content);

  /// A file that grows piece by piece under its temporary name. Belongs to its folder.
  class Stream {
   public:
    /// @throws InputError where the piece cannot be written: at once or with a later piece
    void write(const std::string& piece);
    /// Says how large it will be. @throws InputError where the disk has no room for that
    void expect(double bytes) const;
    /// It is complete. Also at commit(). @throws InputError
    void finish();

   private:
    friend class OutputFolder;
    struct Closer {
      void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Closer> file_;
    std::filesystem::path shown_;
  };
  /// Opens such a file; it is complete at commit(). @throws InputError
  Stream& open(const std::string& name);
  /// The temporary name of a file that others write: it must be complete at commit().
  /// @throws InputError
  std::filesystem::path reserve(const std::string& name);

  /// The folder.
  const std::filesystem::path& path() const { return folder_; }
  /// Names of the files so far, in the order in which they were added.
  std::vector<std::string> names() const;

  /// Puts all files in place; returns their paths.
  /// @param record    one of the files, which names the whole set. Files that the record of an
  ///                  earlier run names and that this set lacks are removed: they belong to a
  ///                  result that is no longer there. Not those changed since.
  /// @param names_in  reads the names from the text of a record
  /// @throws InputError
  using NamesIn = std::function<std::vector<std::string>(const std::string& text)>;
  std::vector<std::filesystem::path> commit(const std::string& record = "",
                                            const NamesIn& names_in = {});

 private:
  std::filesystem::path folder_;
  std::filesystem::path created_;  // topmost folder that did not exist before; empty if none
  struct Pending {
    std::filesystem::path temporary, final_path, before;  // before: where what it replaces waits
  };
  std::vector<std::filesystem::path> superseded(const std::string& record,
                                                const NamesIn& names_in) const;
  void put_back() noexcept;

  std::optional<StagingFolder> staging_;  // made with the first file
  std::vector<Pending> pending_;
  std::vector<std::unique_ptr<Stream>> streams_;
};

/// A single file in a folder that may be missing. @throws InputError
void write_file(const std::filesystem::path& file, const std::string& content);

}  // namespace bentaxis
