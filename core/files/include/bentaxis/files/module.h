// A part of the program that is a file of its own, because of the large libraries it is linked
// with: loaded when it is first wanted, so that no other command waits for it.
#pragma once

#include <string>

namespace bentaxis {

class Module {
 public:
  /// @param file  name of the file, as "bentaxis_openturns.so"; "": the program was built without
  /// it
  explicit Module(const std::string& file);
  /// A function of the module by its name; null where the module or the function is missing.
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }
  /// A table of functions of the module by its name.
  /// @throws InputError where the module or the table is missing: which file, for what, and why
  template <class Table>
  const Table& table(const char* name, const std::string& what) const {
    if (symbol(name) == nullptr) refuse(what);
    return *static_cast<const Table*>(symbol(name));
  }
  bool loaded() const { return library_ != nullptr; }
  /// Which file is missing, in which folders, and what to do; or why it could not be loaded.
  std::string what_is_wrong() const;
  /// Why the module could not be loaded; "" where there is none.
  const std::string& why() const { return why_; }

 private:
  void* symbol(const char* name) const;
  [[noreturn]] void refuse(const std::string& what) const;

  std::string file_;
  void* library_ = nullptr;
  std::string why_;
};

}  // namespace bentaxis
