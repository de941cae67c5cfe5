#include "command_parser.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdio>
#include <type_traits>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/words.h"
#include "data_folder.h"
#include "shipped_cases.h"

namespace bentaxis::cli {
namespace {

constexpr const char* kAnyNumber = "number";  // the check of options without a range
constexpr const char* kNotEmpty = "not empty";

CLI::Validator number_that(const std::string& range, const std::function<bool(double)>& allowed,
                           bool integer = false) {
  return {[=](const std::string& text) {
            double value = 0;
            if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && allowed(value)) {
              // An option that counts is read as an integer: "1e3" is none.
              long long whole = 0;
              if (!integer || CLI::detail::lexical_cast(text, whole)) return std::string();
              return text + ": must be " + range + ", written without an exponent";
            }
            return text + ": must be " + range + (integer ? "" : decimal_point_hint(text));
          },
          ""};
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

// "; did you mean ..?", or nothing.
std::string hint(const std::string& word, const std::vector<std::string>& known) {
  const auto nearest = meant(word, {known.begin(), known.end()});
  return nearest ? "; did you mean \"" + *nearest + "\"?" : "";
}

// Index of a word as text; nothing where it is none of them.
std::optional<std::string> index_of(const std::string& word,
                                    const std::vector<std::string>& words) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) return std::nullopt;
  return std::to_string(found - words.begin());
}

std::string refused(const std::string& word, const std::vector<std::string>& words) {
  return word + ": must be " + listed(words) + hint(word, words);
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name()};
  std::vector<std::string> names;
  for (const auto& name : option.get_snames()) names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

// What an argument that nobody expected was probably meant to be.
std::string unexpected(const CLI::App& command, const std::string& argument) {
  const bool program = command.get_parent() == nullptr;
  const std::string has = program ? "there is " : command.get_name() + " has ";
  if (argument.front() == '-') {
    const std::string option = argument.substr(0, argument.find('='));
    std::vector<std::string> known;
    for (const CLI::Option* one : command.get_options())
      for (const std::string& known_name : names_of(*one)) known.push_back(known_name);
    return has + "no option " + option + hint(option, known);
  }
  const auto commands = commands_of(command);
  if (commands.empty()) return command.get_name() + ": " + argument + " was not expected";
  const std::string nearest = hint(argument, commands);
  return has + "no command " + argument +
         (nearest.empty() ? "; there are: " + listed(commands) : nearest);
}

// A refusal in words; what is misspelt goes before what is missing for that reason.
std::string words_for(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  std::string what = error.what();
  const auto is = [&](auto kind) { return dynamic_cast<const decltype(kind)*>(&error) != nullptr; };
  const bool missing = is(CLI::RequiredError(""));
  if (missing || is(CLI::ExtrasError({}))) {
    std::vector<std::string> arguments = program.remaining(true);
    std::stable_partition(arguments.begin(), arguments.end(),
                          [](const std::string& argument) { return argument.starts_with("--"); });
    if (!arguments.empty() && !arguments.front().empty())
      return unexpected(*command, arguments.front());
    if (const auto commands = commands_of(*command); !commands.empty())
      return command->get_name() + " needs a command: " + listed(commands);
  }
  for (const CLI::Option* option : command->get_options()) {
    const std::string name = option->get_name();
    if (missing && option->get_positional() && what == name + " is required")
      return command->get_name() + ": " + option->get_option_text() + " is missing";
    if (is(CLI::ArgumentMismatch("")) && what.starts_with(name + ": "))
      return option->count() > 1 ? name + " is given more than once"
                                 : name + " needs a value: " + option->get_option_text();
  }
  return what;
}

constexpr const char* kChoiceType = "WORD";  // in messages

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::text(const std::string& values) {
  option_->option_text(values);
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Values Values::with(Setting setting) const {
  Values values = *this;
  values.settings_.push_back(std::move(setting));
  return values;
}

void Values::set(Option& option) const {
  if (!text_.empty()) option.text(text_);
  for (const Setting& setting : settings_) setting(option);
}

Values Values::only(const std::string& range, const std::function<bool(double)>& allowed,
                    bool integer, const std::string& text) {
  return Values(text).with([=](Option& it) {
    it.option_->get_validator(kAnyNumber)->active(false);
    it.option_->check(number_that(range, allowed, integer));
  });
}

Values Values::numbers(double low, double high, const std::string& text) {
  return only(
      "in [" + number_text(low) + ", " + number_text(high) + "]",
      [=](double value) { return value >= low && value <= high; }, false, text);
}

Values Values::positive(const std::string& text, double high) {
  return only(
      std::isfinite(high) ? "a number > 0, at most " + number_text(high) : "a finite number > 0",
      [=](double value) { return value > 0 && value <= high; }, false, text);
}

Values Values::accuracies(const std::string& text) { return numbers(1e-12, 0.1, text); }

Values Values::integers(int low, int high, const std::string& text) {
  return only(
      "an integer in [" + std::to_string(low) + ", " + std::to_string(high) + "]",
      [=](double value) { return value >= low && value <= high && value == std::floor(value); },
      true, text);
}

Values Values::words(const std::vector<std::string>& words, const std::string& text) {
  return Values(text).completed_with(words).with([words](Option& it) {
    it.option_->check(CLI::Validator(
        [words](const std::string& given) {
          return index_of(given, words) ? std::string() : refused(given, words);
        },
        ""));
  });
}

Values Values::case_file(const std::string& text) {
  return Values(text).completed_with(case_names(shipped_cases())).with([](Option& it) {
    it.option_->transform(CLI::Validator(
        [](std::string& given) {
          given = cli::case_file(given, shipped_cases());
          return std::string();
        },
        ""));
  });
}

Values Values::required() const {
  return with([](Option& it) { it.required(); });
}

Values Values::list() const {
  return with([](Option& it) { it.option_->delimiter(','); });
}

Values Values::one() const {
  return with([](Option& it) { it.option_->expected(1); });
}

Values Values::repeated() const {
  return with([](Option& it) { it.option_->expected(1)->take_all(); });
}

Values Values::may_be_empty() const {
  return with([](Option& it) { it.option_->get_validator(kNotEmpty)->active(false); });
}

Values Values::completed_with(const std::vector<std::string>& words) const {
  return with([words](Option& it) { (*it.words_)[it.option_] = words; });
}

CommandParser CommandParser::subcommand(const std::string& name, const std::string& what) {
  return {app_->add_subcommand(name, what), words_};
}

void CommandParser::place(const std::string& group, const std::string& example) {
  app_->group(group);
  app_->footer("Example:\n  " + example);
}

void CommandParser::lacks(const std::string& what) {
  app_->description(app_->get_description() + " (not in this build: it has no " + what + ")");
}

void CommandParser::require_subcommand() { app_->require_subcommand(1); }

void CommandParser::accept_anything() { app_->allow_extras(); }

namespace {

// How the help text shows the values of a variable, with the one that it has by now.
std::string shown(double value) {
  std::string text = number_text(value);
  if (const auto at = text.find("e-0"); at != std::string::npos) text.erase(at + 2, 1);
  return "NUMBER [" + text + "]";  // 1e-9, not 1e-09
}
std::string shown(std::integral auto value) { return "NUMBER [" + std::to_string(value) + "]"; }
std::string shown(const std::optional<double>&) { return "NUMBER"; }
std::string shown(const std::vector<double>& values) {
  return "NUMBER[,NUMBER..]" +
         (values.empty() ? "" : " [" + joined(values, ",", number_text) + "]");
}

}  // namespace

Option CommandParser::wrapped(CLI::Option* option, const Values& values) const {
  Option one(option, words_);
  values.set(one);
  return one;
}

template <class Variable>
Option CommandParser::option(const std::string& name, Variable& value, const Values& values,
                             const std::string& what) {
  CLI::Option* const option = app_->add_option(name, value, what);
  if constexpr (std::is_same_v<Variable, std::string> ||
                std::is_same_v<Variable, std::vector<std::string>>) {
    // Nothing is what a script passes whose variable is not set: it must not count as not given.
    option->check(CLI::Validator(
        [](const std::string& given) {
          return given.empty() ? std::string("must not be empty") : std::string();
        },
        "", kNotEmpty));
  } else {
    option->check(number_that("a number", [](double) { return true; }).name(kAnyNumber));
    option->option_text(shown(value));
  }
  return wrapped(option, values);
}

#define BENTAXIS_OPTION_OF(...)                                                      \
  template Option CommandParser::option(const std::string& name, __VA_ARGS__& value, \
                                        const Values& values, const std::string& what);
BENTAXIS_OPTION_OF(int)
BENTAXIS_OPTION_OF(std::size_t)
BENTAXIS_OPTION_OF(double)
BENTAXIS_OPTION_OF(std::optional<double>)
BENTAXIS_OPTION_OF(std::vector<double>)
BENTAXIS_OPTION_OF(std::string)
BENTAXIS_OPTION_OF(std::vector<std::string>)
#undef BENTAXIS_OPTION_OF

void CommandParser::flag(const std::string& name, bool& value, const std::string& what) {
  app_->add_flag(name, value, what);
}

// Of words that are replaced by their places.
Values CommandParser::places_of(const std::vector<std::string>& words, const std::string& text) {
  return Values(text).completed_with(words).with([words](Option& it) {
    it.option_->type_name(kChoiceType);
    it.option_->transform(CLI::Validator(
        [words](std::string& given) {
          const auto index = index_of(given, words);
          if (!index) return refused(given, words);
          given = *index;
          return std::string();
        },
        ""));
  });
}

Option CommandParser::choice_of(const std::string& name, const std::function<void(int)>& set,
                                const std::vector<std::string>& words, const std::string& what,
                                const std::string& otherwise) {
  return wrapped(app_->add_option_function<int>(
                     name, [set](const int& index) { set(index); }, what),
                 places_of(words, CLI::detail::join(words, "|") + " [" + otherwise + "]"));
}

Option CommandParser::choices_of(const std::string& name,
                                 const std::function<void(const std::vector<int>&)>& set,
                                 const std::vector<std::string>& words, const std::string& what) {
  return wrapped(app_->add_option_function<std::vector<int>>(name, set, what),
                 places_of(words, "NAME[,NAME..] [" + CLI::detail::join(words, ",") + "]").list());
}

CommandInfo CommandParser::info() const {
  CommandInfo info{
      app_->get_name(), app_->get_description(), app_->get_group(), app_->get_footer(), {}, {}};
  for (const CLI::Option* option : app_->get_options()) {
    OptionInfo one;
    one.names = names_of(*option);
    one.values = option->get_option_text();
    one.what = option->get_description();
    if (const auto words = words_->find(option); words != words_->end()) one.words = words->second;
    one.is_argument = option->get_positional();
    one.takes_value = option->get_items_expected_max() > 0;
    one.takes_several = option->get_delimiter() == ',';
    one.required = option->get_required();
    info.options.push_back(std::move(one));
  }
  for (CLI::App* command : app_->get_subcommands([](CLI::App*) { return true; }))
    info.commands.push_back(CommandParser(command, words_).info());
  return info;
}

bool CommandParser::parsed() const { return app_->parsed(); }

bool CommandParser::given(const std::string& name) const {
  return app_->get_option(name)->count() > 0;
}

std::string CommandParser::footer() const { return app_->get_footer(); }

ProgramParser::ProgramParser(const Texts& texts)
    : app_(std::make_unique<CLI::App>(texts.what, texts.name)) {
  app_->set_version_flag("--version", texts.version);
  app_->require_subcommand(0, 1);
  app_->footer(texts.footer);
}

ProgramParser::~ProgramParser() = default;

// The argument by the option's present name. Says on standard error that it has one.
std::string ProgramParser::with_new_names(const std::string& command, const std::string& argument) {
  const std::size_t end = std::min(argument.find('='), argument.size());
  const auto found = renamed_.find({command, argument.substr(0, end)});
  if (found == renamed_.end()) return argument;
  if (told_.insert(found->first.second).second)
    std::fprintf(stderr, "bentaxis: %s: %s is now called %s; the former name goes on working\n",
                 command.c_str(), found->first.second.c_str(), found->second.c_str());
  return found->second + argument.substr(end);
}

bool ProgramParser::parse(int argc, char** argv) {
  std::vector<std::string> arguments;
  const CLI::App* command = app_.get();
  std::string name;  // of the command so far
  bool options_end = false;
  for (int i = 1; i < argc; ++i) {
    std::string argument = argv[i];
    options_end = options_end || argument == "--";
    const auto below = commands_of(*command);
    if (contains(below, argument)) {
      command = command->get_subcommand(argument);
      name += (name.empty() ? "" : " ") + argument;
    } else if (!options_end) {
      argument = with_new_names(name, argument);
    }
    arguments.insert(arguments.begin(), argument);  // CLI11 takes them from the end
  }
  try {
    app_->parse(std::move(arguments));
    return true;
  } catch (const CLI::Success& answered) {
    app_->exit(answered);
    return false;
  } catch (const CLI::ParseError& error) {
    throw InputError(words_for(*app_, error) + " (see " + app_->get_name() +
                     (name.empty() ? "" : " " + name) + " --help)");
  }
}

}  // namespace bentaxis::cli
