// Output folders whose files appear whole or not at all.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace bentaxis {

/// Collects the files of a run and puts them in place together: each is written under a temporary
/// name first, and only when all are complete are they renamed. On any failure nothing is left. Of
/// two programs that write the same files, all files are those of the one that ends last.
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

   private:
    friend class OutputFolder;
    struct Closer {
      void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Closer> file_;
    std::filesystem::path shown_;
    void finish();
  };
  /// Opens such a file; it is complete at commit(). @throws InputError
  Stream& open(const std::string& name);

  /// Puts all files in place; returns their paths. @throws InputError
  std::vector<std::filesystem::path> commit();

 private:
  std::filesystem::path folder_;
  std::filesystem::path created_;  // topmost folder that did not exist before; empty if none
  std::vector<std::pair<std::filesystem::path, std::filesystem::path>>
      pending_;  // temporary, final
  std::vector<std::unique_ptr<Stream>> streams_;
};

}  // namespace bentaxis
