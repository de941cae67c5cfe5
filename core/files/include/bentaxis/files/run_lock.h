// Keeps two runs out of one folder where their results would mix.
#pragma once

#include <filesystem>
#include <string>

namespace bentaxis {

/// A lock file, held while a run adds to what it and others left in a folder. The system releases
/// the lock when the process ends, also when it is killed. Where the file system has no locks, runs
/// are not kept apart.
class RunLock {
 public:
  enum class Kind {
    alone,   ///< no other run may hold it
    shared,  ///< others of this kind may
    reader   ///< as shared, but no file is made: where there is none, nothing is held
  };
  /// @param file  made with its folder where missing; names the process that holds it alone
  /// @param work  what the holder does, for the message: "sweep"
  /// @throws InputError where another run holds it, or the file cannot be made
  RunLock(std::filesystem::path file, Kind kind, const std::string& work);
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&&) = delete;
  /// Releases the lock. Who held it alone removes the file.
  ~RunLock();

 private:
  bool take(Kind kind, const std::string& work);
  bool is_in_place() const;

  std::filesystem::path file_;
  int handle_ = -1;
  bool alone_ = false;
};

}  // namespace bentaxis
