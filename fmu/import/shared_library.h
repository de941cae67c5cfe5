// A unit's library, its functions by name. Internal.
#pragma once

#include <filesystem>
#include <string>

namespace bentaxis::fmu {

class SharedLibrary {
 public:
  /// @param unit  its file, for messages
  /// @throws InputError where it cannot be loaded
  SharedLibrary(const std::filesystem::path& library, std::string unit);
  ~SharedLibrary();
  SharedLibrary(const SharedLibrary&) = delete;
  SharedLibrary& operator=(const SharedLibrary&) = delete;

  /// @throws InputError where the library has no such function
  template <class Function>
  void find(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(needed(name));
  }
  /// nullptr where there is none.
  template <class Function>
  void find_optional(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;
  void* needed(const char* name) const;
  std::string unit_;
  void* handle_ = nullptr;
};

}  // namespace bentaxis::fmu
