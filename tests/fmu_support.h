// The library of a unit as an importer loads it, and folders of resources.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "bentaxis/files/case_file.h"
#include "interface/fmi2.h"
#include "interface/fmi3.h"
#include "runtime/variables.h"

namespace bentaxis::fmu {

/// Every function by its name.
struct Functions {
#define BENTAXIS_MEMBER(name) name##TYPE* name = nullptr;
  BENTAXIS_FMI2_FUNCTIONS(BENTAXIS_MEMBER)
  BENTAXIS_FMI3_FUNCTIONS(BENTAXIS_MEMBER)
#undef BENTAXIS_MEMBER

  Functions() {
    void* const library = dlopen(BENTAXIS_FMU_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) throw std::runtime_error(dlerror());
#define BENTAXIS_FIND(name) name = reinterpret_cast<name##TYPE*>(dlsym(library, #name));
    BENTAXIS_FMI2_FUNCTIONS(BENTAXIS_FIND)
    BENTAXIS_FMI3_FUNCTIONS(BENTAXIS_FIND)
#undef BENTAXIS_FIND
  }
};

inline const Functions& library() {
  static const Functions functions;
  return functions;
}

/// What an instance has said.
struct Messages {
  std::string text;  // all, one line each: "status category: message"
  bool has(const std::string& words) const { return text.find(words) != std::string::npos; }
};

inline void log2(fmi2ComponentEnvironment environment, fmi2String /*name*/, fmi2Status status,
                 fmi2String category, fmi2String message, ...) {
  char line[4096];
  va_list arguments;
  va_start(arguments, message);
  std::vsnprintf(line, sizeof line, message, arguments);
  va_end(arguments);
  if (environment == nullptr) return;
  static_cast<Messages*>(environment)->text +=
      std::to_string(status) + " " + category + ": " + line + "\n";
}

inline void log3(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                 fmi3String message) {
  if (environment == nullptr) return;
  static_cast<Messages*>(environment)->text +=
      std::to_string(status) + " " + category + ": " + message + "\n";
}

constexpr const char* kToken = "{01234567-89ab-cdef-0123-456789abcdef}";

/// A folder of resources as an archive has it, gone with this.
class Resources {
 public:
  explicit Resources(const std::string& case_name, const std::string& drive = "speed",
                     const std::string& folder = "resources") {
    static int count = 0;
    top_ = std::filesystem::temp_directory_path() /
           ("bentaxis_fmu_" + std::to_string(getpid()) + "_" + std::to_string(++count));
    path_ = top_ / folder;
    std::filesystem::create_directories(path_);
    std::filesystem::copy_file(BENTAXIS_SOURCE_DIR "/cases/" + case_name, path_ / "case.toml");
    write("unit.txt", "drive " + drive + "\ntolerance 1e-9\ntoken " + kToken + "\n");
    choice_.drive = drive == "speed"    ? Drive::speed
                    : drive == "torque" ? Drive::torque
                                        : Drive::as_in_case;
    variables_ = variables_of(read_case(path_ / "case.toml"), choice_);
  }
  ~Resources() { std::filesystem::remove_all(top_); }
  Resources(const Resources&) = delete;
  Resources& operator=(const Resources&) = delete;

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
  }
  void replace(const std::string& from, const std::string& to) const {
    std::ostringstream text;
    text << std::ifstream(path_ / "case.toml").rdbuf();
    std::string all = text.str();
    const auto at = all.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write("case.toml", all.replace(at, from.size(), to));
  }
  const std::filesystem::path& path() const { return path_; }
  std::string uri() const { return "file://" + path_.string(); }
  const std::vector<Variable>& variables() const { return variables_; }
  unsigned operator[](const std::string& name) const {
    for (const Variable& it : variables_)
      if (it.name == name) return it.reference;
    throw std::runtime_error("no variable " + name);
  }
  std::vector<unsigned> of(Causality causality) const {
    std::vector<unsigned> references;
    for (const Variable& it : variables_)
      if (it.causality == causality && !it.boolean) references.push_back(it.reference);
    return references;
  }

 private:
  std::filesystem::path top_, path_;
  UnitChoice choice_;
  std::vector<Variable> variables_;
};

}  // namespace bentaxis::fmu
