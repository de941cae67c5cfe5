// bentaxis docs: the documentation site that came with the program.
#include <spawn.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

#include "command_tools.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX declares it nowhere

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;

fs::path start_page() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const auto site = shipped_folder("site", program, BENTAXIS_DOCUMENTS_FROM_BINARY);
  fs::path page = site.value_or(fs::path()) / "index.html";
  if (!site || !fs::is_regular_file(page, error)) {
    const auto texts = shipped_folder("docs", program, BENTAXIS_DOCUMENTS_FROM_BINARY);
    throw InputError(
        "the documentation site is not there; in the source tree \"scripts/setup docs\" and "
        "\"scripts/build_site\" build it, the Debian package holds it" +
        (texts ? "; its pages as text: " + (*texts / "README.md").string() : ""));
  }
  return page;
}

// By the program that the desktop has for pages; false where there is none, or no desktop.
bool open_in_browser(const fs::path& page) {
  const auto is_set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") && !is_set("BROWSER")) return false;
  std::string opener = "xdg-open", path = page.string();
  char* arguments[] = {opener.data(), path.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, opener.c_str(), nullptr, nullptr, arguments, environ) != 0) return false;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

int docs(bool only_print) {
  const fs::path page = start_page();
  std::printf("%s\n", page.c_str());
  std::fflush(stdout);
  if (!only_print && !open_in_browser(page))
    std::fprintf(stderr, "bentaxis: no browser could be started; open this file in one\n");
  return kDone;
}

}  // namespace

Command add_docs_command(CommandParser program) {
  auto command =
      program.subcommand("docs", "Open the documentation in the browser and print its path");
  const auto only_print = std::make_shared<bool>(false);
  command.flag("--print", *only_print, "print the path only");
  return {command, [only_print] { return docs(*only_print); }};
}

}  // namespace bentaxis::cli
