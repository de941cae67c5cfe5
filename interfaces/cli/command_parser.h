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

/// An option or argument of a command. What is said about it can be chained.
class Option {
 public:
  Option(CLI::Option* option, std::shared_ptr<OptionWords> words)
      : option_(option), words_(std::move(words)) {}

  Option& required();
  /// A case file, or the name of a shipped case, which is replaced by its file.
  Option& case_file();
  /// Its values in the help text, as in "NUMBER [36]".
  Option& text(const std::string& values);
  Option& list();          ///< values are parted by commas too
  Option& one_value();     ///< of an option that could take several
  Option& repeatable();    ///< one value each time it is given; all are kept
  Option& may_be_empty();  ///< of a text, which otherwise is refused where it is ""
  Option& excludes(const Option& other);

  Option& number_in(double low, double high);       ///< finite, in [low, high]
  Option& positive_number(double high = HUGE_VAL);  ///< finite, above 0
  Option& accuracy();                               ///< what Simbody's integrators accept
  Option& integer_in(int low, int high);            ///< in [low, high]
  Option& one_of(const std::vector<std::string>& words);
  Option& completed_with(const std::vector<std::string>& words);  ///< others may be given too

 private:
  friend class CommandParser;
  Option& only(const std::string& range, const std::function<bool(double)>& allowed,
               bool integer = false);
  Option& choice(const std::vector<std::string>& words);

  CLI::Option* option_;
  std::shared_ptr<OptionWords> words_;
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

  Option option(const std::string& name, int& value, const std::string& what);
  Option option(const std::string& name, double& value, const std::string& what);
  Option option(const std::string& name, std::string& value, const std::string& what);
  Option option(const std::string& name, std::optional<double>& value, const std::string& what);
  Option option(const std::string& name, std::vector<double>& values, const std::string& what);
  Option option(const std::string& name, std::vector<std::string>& values, const std::string& what);

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
  Option wrapped(CLI::Option* option) const { return {option, words_}; }

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
