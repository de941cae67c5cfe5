// The parser of the command line as the commands see it. The library that does the work, CLI11, is
// seen by command_parser.cpp alone: its headers cost every file that includes them seconds.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bentaxis::cli {

/// What the parser knows of an option or argument: for the manual and for completion.
struct OptionInfo {
  std::vector<std::string> names;  ///< "--out"; "-h", "--help"; of an argument "case"
  std::string values;              ///< as the help text has them: "DIR [out]"
  std::string what;
  std::vector<std::string> words;  ///< that can be its value, or stand in its list
  bool is_argument = false, takes_value = false, takes_several = false, required = false;
};

/// What the parser knows of a command, or of the program.
struct CommandInfo {
  std::string name, what;
  std::string group, example;       ///< as placed() says
  std::vector<OptionInfo> options;  ///< arguments too
  std::vector<CommandInfo> commands;
};

/// Words that options are completed with.
using OptionWords = std::map<const CLI::Option*, std::vector<std::string>>;

/// An option or argument of a command.
class Option {
 public:
  Option(CLI::Option* option, std::shared_ptr<OptionWords> words)
      : option_(option), words_(std::move(words)) {}

  Option& required();
  /// Its values in the help text, as in "NUMBER [36]".
  Option& text(const std::string& values);
  Option& excludes(const Option& other);

 private:
  friend class CommandParser;
  friend class Values;
  CLI::Option* option_;
  std::shared_ptr<OptionWords> words_;
};

/// What an option takes: which values, and how the help text shows them. A text alone allows any.
/// Without a text that of the variable is shown, "NUMBER" with its value by then: "NUMBER [36]".
class Values {
 public:
  Values() = default;
  Values(const char* text) : text_(text) {}
  Values(std::string text) : text_(std::move(text)) {}

  static Values numbers(double low, double high, const std::string& text = {});  ///< finite
  static Values positive(const std::string& text = {}, double high = HUGE_VAL);  ///< finite
  static Values accuracies(const std::string& text = {});  ///< what Simbody's integrators accept
  static Values integers(int low, int high, const std::string& text = {});
  static Values words(const std::vector<std::string>& words, const std::string& text);
  /// A case file, or the name of a shipped case, which is replaced by its file.
  static Values case_file(const std::string& text);

  Values required() const;
  Values list() const;          ///< parted by commas too
  Values one() const;           ///< of a variable that could take several
  Values repeated() const;      ///< one value each time the option is given; all are kept
  Values may_be_empty() const;  ///< of a text, which otherwise is refused where it is ""
  Values completed_with(const std::vector<std::string>& words) const;  ///< others may be given too

 private:
  friend class CommandParser;
  using Setting = std::function<void(Option&)>;
  Values with(Setting setting) const;
  static Values only(const std::string& range, const std::function<bool(double)>& allowed,
                     bool integer, const std::string& text);
  void set(Option& option) const;

  std::string text_;  // empty: the variable's
  std::vector<Setting> settings_;
};

/// A command and its options. Variables that options fill must live until the line is parsed; they
/// stay as they are where the option is not given. A name without dashes is that of an argument.
class CommandParser {
 public:
  CommandParser(CLI::App* app, std::shared_ptr<OptionWords> words)
      : app_(app), words_(std::move(words)) {}

  CommandParser subcommand(const std::string& name, const std::string& what);
  /// In which group the help text lists the command, and a line that calls it.
  void place(const std::string& group, const std::string& example);
  /// Says in the list of commands that it cannot run in this build. @param what  that it lacks
  void lacks(const std::string& what);
  void require_subcommand();
  /// Any arguments and options may follow, whatever they are.
  void accept_anything();

  /// @param value  int, std::size_t, double, std::optional<double>, std::vector<double>,
  /// std::string
  ///               or std::vector<std::string>
  template <class Variable>
  Option option(const std::string& name, Variable& value, const Values& values,
                const std::string& what);
  template <class Variable>
  Option option(const std::string& name, Variable& value, const std::string& what) {
    return option(name, value, Values(), what);
  }

  void flag(const std::string& name, bool& value, const std::string& what);

  /// An option whose values are an enumeration's names in its order. Its text is
  /// "WORD|WORD.. [default]".
  template <class Enumeration>
  Option choice(const std::string& name, Enumeration& value, const std::vector<std::string>& words,
                const std::string& what) {
    return choice_of(
        name, [&value](int index) { value = static_cast<Enumeration>(index); }, words, what,
        words[static_cast<std::size_t>(value)]);
  }
  /// A list of such values. Its text is "NAME[,NAME..] [all words]".
  template <class Enumeration>
  Option choices(const std::string& name, std::vector<Enumeration>& values,
                 const std::vector<std::string>& words, const std::string& what) {
    const auto set = [&values](const std::vector<int>& indices) {
      values.clear();
      for (const int index : indices) values.push_back(static_cast<Enumeration>(index));
    };
    return choices_of(name, set, words, what);
  }

  bool parsed() const;                        ///< was this command given?
  bool given(const std::string& name) const;  ///< was this option of it given?
  CommandInfo info() const;                   ///< with all that has been added
  std::string footer() const;                 ///< the text under the help text

 private:
  Option choice_of(const std::string& name, const std::function<void(int)>& set,
                   const std::vector<std::string>& words, const std::string& what,
                   const std::string& otherwise);
  Option choices_of(const std::string& name,
                    const std::function<void(const std::vector<int>&)>& set,
                    const std::vector<std::string>& words, const std::string& what);
  Option wrapped(CLI::Option* option, const Values& values) const;
  static Values places_of(const std::vector<std::string>& words, const std::string& text);

  CLI::App* app_;
  std::shared_ptr<OptionWords> words_;
};

/// The parser of the whole program, which owns those of its commands.
class ProgramParser {
 public:
  struct Texts {
    std::string name, what, version, footer;
  };
  explicit ProgramParser(const Texts& texts);
  ~ProgramParser();
  ProgramParser(const ProgramParser&) = delete;
  ProgramParser& operator=(const ProgramParser&) = delete;

  /// The program as the command that the commands are added to.
  CommandParser root() { return {app_.get(), words_}; }

  /// An option that had another name: the former one goes on working, and standard error says the
  /// new one. @param command  "reference golden"
  void renamed(const std::string& command, const std::string& former, const std::string& option) {
    renamed_[{command, former}] = option;
  }

  /// @return false where the line asked for --help or --version, which are then printed
  /// @throws InputError
  bool parse(int argc, char** argv);

 private:
  std::string with_new_names(const std::string& command, const std::string& argument);

  std::unique_ptr<CLI::App> app_;
  std::shared_ptr<OptionWords> words_ = std::make_shared<OptionWords>();
  std::map<std::pair<std::string, std::string>, std::string> renamed_;
  std::set<std::string> told_;  // former names that were given
};

}  // namespace bentaxis::cli
