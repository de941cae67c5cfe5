// The supervisor of an FMU's processes as the program has it. Internal.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <mutex>
#include <string>

namespace bentaxis::fmu {

/// A process that starts, watches and ends those of instances, and that removes the folder when it
/// is not wanted any more or the program has ended, in whatever way.
class Supervisor {
 public:
  /// @param folder  of the unpacked FMU, absolute; receives the supervisor's program
  /// @param fmu     its file, for messages
  /// @throws ComputationError where the process cannot be started
  Supervisor(const std::filesystem::path& folder, std::string fmu);
  /// Ends all processes and waits for it.
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Starts a process for an instance. Called by any thread.
  /// @return the program's end of the channel to it, to be closed by the caller: this ends the
  /// process
  /// @throws ComputationError where there is no process
  int new_process();

 private:
  [[noreturn]] void fail(const std::string& why) const;
  void write_program(const std::filesystem::path& file) const;

  std::string fmu_;
  std::mutex busy_;
  pid_t process_ = 0;
  int control_ = -1;
};

}  // namespace bentaxis::fmu
