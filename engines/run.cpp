#include "bentaxis/engines/run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>

#include "bentaxis/files/module_folders.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/stopwatch.h"
#include "shared_task.h"

namespace bentaxis::engines {
namespace {

constexpr double kLongest = 600;         // s, of a process
constexpr useconds_t kLookEvery = 2000;  // us

std::filesystem::path find_file(const std::string& file) {
  std::vector<std::filesystem::path> folders = module_folders();
  if (const char* more = std::getenv("BENTAXIS_ENGINE_PATH")) {
    std::istringstream list(more);
    std::vector<std::filesystem::path> named;
    for (std::string folder; std::getline(list, folder, ':');)
      if (!folder.empty()) named.emplace_back(folder);
    folders.insert(folders.begin(), named.begin(), named.end());
  }
  std::error_code none;
  for (const auto& folder : folders)
    if (std::filesystem::exists(folder / file, none))
      return std::filesystem::absolute(folder / file);
  return {};
}

std::string module_of(const std::string& name) { return "bentaxis_engine_" + name + ".so"; }

// Memory that a child process gets as a descriptor.
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t size)
      : size_(size), file_(memfd_create("bentaxis", MFD_CLOEXEC)) {
    if (file_ < 0 || ftruncate(file_, static_cast<off_t>(size)) != 0) return;
    void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    if (memory != MAP_FAILED) memory_ = memory;
  }
  ~SharedMemory() {
    if (memory_ != nullptr) munmap(memory_, size_);
    if (file_ >= 0) close(file_);
  }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  int file() const { return file_; }
  void* get() const { return memory_; }

 private:
  std::size_t size_;
  int file_;
  void* memory_ = nullptr;
};

// Fills the arrays of a task, which an engine only reads.
void write(const Mechanism& m, bentaxis_engine_task at) {
  const auto set = [](auto*& array, auto value) { *const_cast<decltype(value)*>(array++) = value; };
  const auto put = [&](const double*& array, const auto& numbers) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(numbers.size()); ++i)
      set(array, numbers.data()[i]);
  };
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    const Body& body = m.bodies[i];
    set(at.parent, body.parent);
    set(at.mass, body.mass);
    put(at.place, body.place);
    put(at.axes, body.axes);
    put(at.centre, body.centre);
    put(at.inertia, body.inertia);
    for (const Freedom& freedom : body.freedoms) {
      set(at.freedom_body, static_cast<std::int32_t>(i));
      set(at.freedom_turns, freedom.turns ? 1 : 0);
      set(at.freedom_driven, freedom.driven ? 1 : 0);
      put(at.freedom_axis, freedom.axis);
    }
  }
  for (const Action& action : m.actions) {
    set(at.action_on, action.on);
    set(at.action_by, action.by);
  }
  for (const Support& support : m.supports) set(at.support_body, support.body);
  for (const Loop& loop : m.loops) {
    set(at.loop_on, loop.on);
    set(at.loop_by, loop.by);
    set(at.loop_action, loop.action);
    put(at.loop_point_on, loop.point_on);
    put(at.loop_point_by, loop.point_by);
  }
  for (const State& state : m.states) {
    put(at.position, state.position);
    put(at.velocity, state.velocity);
    put(at.acceleration, state.acceleration);
    for (const Wrench& load : state.loads) put(at.loads, load);
    for (const Wrench& support : state.supports) put(at.support, support);
    for (const Wrench& action : state.actions) put(at.action, action);
  }
}

// The last line that a process has printed.
std::string last_words(int file) {
  std::string text(4096, 0);
  const off_t size = lseek(file, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(text.size()));
  const ssize_t read = pread(file, text.data(), text.size(), from);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read)));
  while (!text.empty() && (text.back() == '\n' || text.back() == 0)) text.pop_back();
  const std::size_t line = text.rfind('\n');
  return without_control_characters(line == std::string::npos ? text : text.substr(line + 1));
}

// Starts the runner, waits for it. @return how it ended, or nothing: it was ended here
std::optional<int> run_process(const std::string& runner, const std::string& module, int memory,
                               int output, const Progress& progress) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&files, memory, 3);
  posix_spawn_file_actions_addclosefrom_np(&files, 4);
  std::string program = runner, argument = module;
  char* arguments[] = {program.data(), argument.data(), nullptr};
  pid_t process = 0;
  const int failed = posix_spawn(&process, runner.c_str(), &files, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) return 127 << 8;
  const Stopwatch stopwatch;
  int status = 0;
  const auto end = [&] {
    kill(process, SIGKILL);
    waitpid(process, &status, 0);
  };
  try {
    while (waitpid(process, &status, WNOHANG) == 0) {
      if (stopwatch.seconds() > kLongest) {
        end();
        return std::nullopt;
      }
      progress(0);
      usleep(kLookEvery);
    }
    progress(1);  // an interruption ends the process as well
  } catch (...) {
    end();
    throw;
  }
  return status;
}

std::string how_it_ended(const std::optional<int>& status, const std::string& words) {
  if (!status) return fmt::format("did not end within {:g} s", kLongest);
  const std::string said = words.empty() ? "" : ": " + words;
  if (WIFSIGNALED(*status))
    return fmt::format("crashed (signal {}, {}){}", WTERMSIG(*status), strsignal(WTERMSIG(*status)),
                       said);
  return fmt::format("ended before it had answered (exit status {}){}", WEXITSTATUS(*status), said);
}

}  // namespace

const std::vector<std::string>& known_engines() {
  static const std::vector<std::string> names = {"mujoco", "dart", "bullet"};
  return names;
}

std::vector<std::string> installed_engines() {
  std::vector<std::string> names = known_engines();
  std::erase_if(names, [](const std::string& name) { return find_file(module_of(name)).empty(); });
  return names;
}

bool is_engine(const std::string& name) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), is_letter)) return false;
  return contains(known_engines(), name) || !find_file(module_of(name)).empty();
}

namespace {

// A task in shared memory, after an engine has had it; or why it has not.
struct Done {
  std::string failure;
  std::unique_ptr<SharedMemory> memory;
  Shared* shared = nullptr;
  bentaxis_engine_answer answer{};
  double seconds = 0;
  std::string text() const { return without_control_characters(shared->text); }
};

// @return why there is no answer, or nothing
std::string run_in(Done& done, const std::string& name, const Shared& counts, const Mechanism& m,
                   const Progress& progress) {
  const std::filesystem::path module = find_file(module_of(name));
  if (module.empty())
    return "is not installed: there is no " + module_of(name) +
           " beside the program or in BENTAXIS_ENGINE_PATH";
  const std::filesystem::path runner = find_file("bentaxis_engine_runner");
  if (runner.empty()) return "cannot be run: there is no bentaxis_engine_runner beside the program";
  bentaxis_engine_task task = counts.task;
  done.memory = std::make_unique<SharedMemory>(lay_out(nullptr, task, done.answer));
  const SharedMemory output(1);
  if (done.memory->get() == nullptr || output.get() == nullptr) return "there is no memory for it";
  done.shared = new (done.memory->get()) Shared(counts);
  lay_out(done.shared, task, done.answer);
  write(m, task);
  const Stopwatch stopwatch;
  const std::optional<int> status =
      run_process(runner.string(), module.string(), done.memory->file(), output.file(), progress);
  done.seconds = stopwatch.seconds();
  done.shared->text[sizeof done.shared->text - 1] = 0;
  switch (done.shared->outcome) {
    case Outcome::returned:
      return "";
    case Outcome::unfinished:
      return how_it_ended(status, last_words(output.file()));
    case Outcome::not_loaded:
    case Outcome::no_function:
      return module.string() + " is no module of an engine: " + done.text();
    case Outcome::other_interface:
      return fmt::format("{} has interface {}, this program {}", module.string(),
                         done.shared->interface, BENTAXIS_ENGINE_INTERFACE);
  }
  return "has given no answer";
}

Done run_task(const std::string& name, const Shared& counts, const Mechanism& m,
              const Progress& progress) {
  Done done;
  done.failure = run_in(done, name, counts, m, progress);
  if (!done.failure.empty()) done.failure = name + ": " + done.failure;
  return done;
}

// Without a look at the sides of forces.
Answer run_once(const std::string& name, const Mechanism& m, const Progress& progress,
                const std::optional<Integrated>& integrated) {
  Shared counts;
  bentaxis_engine_task& task = counts.task;
  const auto count = [](const auto& list) { return static_cast<std::int32_t>(list.size()); };
  task.bodies = count(m.bodies);
  task.samples = count(m.states);
  task.freedoms = count(m.states.front().position);
  task.actions = count(m.actions);
  task.supports = count(m.supports);
  task.loops = count(m.loops);
  std::copy_n(m.gravity.data(), 3, task.gravity);
  task.length = m.length;
  if (integrated) {
    task.request = BENTAXIS_ENGINE_INTEGRATED;
    task.interval = integrated->interval;
    task.first = integrated->first;
    task.every = integrated->every;
    std::snprintf(counts.settings, sizeof counts.settings, "%s", integrated->settings.c_str());
  }
  const Done done = run_task(name, counts, m, progress);
  Answer answer;
  answer.failure = done.failure;
  answer.seconds = done.seconds;
  if (!answer.failure.empty()) return answer;
  answer.text = done.text();
  answer.turn_seconds = done.shared->seconds;
  const std::size_t width = m.actions.size() + m.supports.size();
  const auto row = [&](std::size_t sample) { return done.answer.values + sample * width; };
  // A step begins at the last result.
  const std::size_t end = integrated ? m.states.size() - 2 : m.states.size();
  for (auto sample = static_cast<std::size_t>(task.first); sample < end;
       sample += static_cast<std::size_t>(task.every)) {
    answer.values.insert(answer.values.end(), row(sample), row(sample + 1));
    answer.residual = std::max(answer.residual, done.answer.residual[sample]);
  }
  if (std::isnan(*done.answer.values))
    answer.failure = name + ": " + answer.text;
  else if (!std::all_of(answer.values.begin(), answer.values.end(),
                        [](double value) { return std::isfinite(value); }))
    answer.failure = name + ": a result is not a number";
  return answer;
}

}  // namespace

Answer run_engine(const std::string& name, const Mechanism& mechanism, const Progress& progress,
                  const std::optional<Integrated>& integrated) {
  Answer answer = run_once(name, mechanism, progress, integrated);
  const auto is_two_sided = [](const Action& action) { return action.two_sided; };
  if (!answer.failure.empty() ||
      std::none_of(mechanism.actions.begin(), mechanism.actions.end(), is_two_sided))
    return answer;
  // The sign of a force does not depend on the side on which it acts.
  Mechanism sided = mechanism;
  const std::size_t width = mechanism.actions.size() + mechanism.supports.size();
  const std::size_t first = integrated ? integrated->first : 0;
  const std::size_t every = integrated ? integrated->every : 1;
  for (std::size_t row = 0; row * width < answer.values.size(); ++row) {
    State& state = sided.states[first + row * every];
    std::size_t side = 0;
    for (std::size_t i = 0; i < mechanism.actions.size(); ++i)
      if (mechanism.actions[i].two_sided) {
        if (answer.values[row * width + i] < 0) state.actions[i] = state.other_sides[side];
        ++side;
      }
  }
  return run_once(name, sided, progress, integrated);
}

std::vector<Setting> settings_of(const std::string& name) {
  Shared counts;
  counts.task.request = BENTAXIS_ENGINE_SETTINGS;
  const Done done = run_task(name, counts, {}, [](double) {});
  std::vector<Setting> settings;
  if (!done.failure.empty()) return settings;
  std::istringstream words(done.text());
  for (std::string word; words >> word;) {
    if (word.find('=') == std::string::npos) continue;
    Setting setting;
    setting.name = word.substr(0, word.find('='));
    std::istringstream parts(word.substr(word.find('=') + 1));
    std::string part;
    std::getline(parts, part, ';');
    std::istringstream values(part);
    for (std::string value; std::getline(values, value, ',');) setting.values.push_back(value);
    while (std::getline(parts, part, ';'))
      if (const auto dots = part.find(".."); dots != std::string::npos) {
        setting.least = part.substr(0, dots);
        setting.most = part.substr(dots + 2);
      } else {
        setting.is_integer |= part == "integer";
      }
    settings.push_back(std::move(setting));
  }
  return settings;
}

std::string Setting::refusal(const std::string& value) const {
  const std::optional<double> lowest = number_in(least), highest = number_in(most);
  if (!lowest || !highest) {
    const bool is_word = !values.empty() && !number_in(values.front());
    return !is_word || contains(values, value) ? "" : "one of " + joined(values);
  }
  const std::optional<double> number = number_in(value);
  if (number && *number >= *lowest && *number <= *highest &&
      (!is_integer || std::floor(*number) == *number))
    return "";
  return fmt::format("{} in [{}, {}]", is_integer ? "an integer" : "a number", least, most);
}

}  // namespace bentaxis::engines
