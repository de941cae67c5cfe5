// A part of the program that is a file of its own, because of the large libraries it is linked
// with: loaded when it is first wanted, so that no other command waits for it.
#pragma once

#include <string>

namespace bentaxis {

class Module {
 public:
  /// @param file  name of the file, as "bentaxis_openturns.so"; "": none
  explicit Module(const std::string& file);
  /// A function of the module by its name.
  /// @throws InputError where the module or the function is missing: which file, for what, and why
  template <class Function>
  Function& function(const char* name, const std::string& what) const {
    return *reinterpret_cast<Function*>(needed(name, what));
  }
  /// A table of functions of the module by its name.
  /// @throws InputError where the module or the table is missing: which file, for what, and why
  template <class Table>
  const Table& table(const char* name, const std::string& what) const {
    return *static_cast<const Table*>(needed(name, what));
  }
  bool loaded() const { return library_ != nullptr; }
  /// Which file is missing, in which folders, and what to do; or why it could not be loaded.
  std::string what_is_wrong() const;

 private:
  void* needed(const char* name, const std::string& what) const;

  std::string file_;
  void* library_ = nullptr;
  std::string why_;
};

}  // namespace bentaxis
