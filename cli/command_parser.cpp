#include "command_parser.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::cli {
namespace {

CLI::Validator number_that(const std::string& range, const std::function<bool(double)>& allowed) {
  return {[=](const std::string& text) {
            double value = 0;
            if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && allowed(value))
              return std::string();
            return text + ": must be " + range;
          },
          ""};
}

CLI::CheckedTransformer index_of(const std::vector<std::string>& words) {
  std::map<std::string, int> indices;
  for (std::size_t i = 0; i < words.size(); ++i) indices[words[i]] = static_cast<int>(i);
  return CLI::CheckedTransformer(indices);
}

constexpr const char* kChoiceType = "ENUM";  // in messages

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::text(const std::string& values) {
  option_->option_text(values);
  return *this;
}

Option& Option::list() {
  option_->delimiter(',');
  return *this;
}

Option& Option::one_value() {
  option_->expected(1);
  return *this;
}

Option& Option::repeatable() {
  option_->expected(1)->take_all();
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Option& Option::number_in(double low, double high) {
  option_->check(number_that("in [" + number_text(low) + ", " + number_text(high) + "]",
                             [=](double value) { return value >= low && value <= high; }));
  return *this;
}

Option& Option::positive_number() {
  option_->check(number_that("a finite number > 0", [](double value) { return value > 0; }));
  return *this;
}

Option& Option::accuracy() { return number_in(1e-12, 0.1); }

Option& Option::integer_in(int low, int high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option& Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

CommandParser CommandParser::subcommand(const std::string& name, const std::string& what) {
  return CommandParser(app_->add_subcommand(name, what));
}

void CommandParser::require_subcommand() { app_->require_subcommand(1); }

Option CommandParser::option(const std::string& name, int& value, const std::string& what) {
  return Option(app_->add_option(name, value, what));
}

Option CommandParser::option(const std::string& name, double& value, const std::string& what) {
  return Option(app_->add_option(name, value, what));
}

Option CommandParser::option(const std::string& name, std::string& value, const std::string& what) {
  return Option(app_->add_option(name, value, what));
}

Option CommandParser::option(const std::string& name, std::optional<double>& value,
                             const std::string& what) {
  return Option(app_->add_option(name, value, what));
}

Option CommandParser::option(const std::string& name, std::vector<double>& values,
                             const std::string& what) {
  return Option(app_->add_option(name, values, what));
}

Option CommandParser::option(const std::string& name, std::vector<std::string>& values,
                             const std::string& what) {
  return Option(app_->add_option(name, values, what));
}

void CommandParser::flag(const std::string& name, bool& value, const std::string& what) {
  app_->add_flag(name, value, what);
}

Option CommandParser::choice_of(const std::string& name, const std::function<void(int)>& set,
                                const std::vector<std::string>& words, const std::string& what,
                                const std::string& otherwise) {
  return Option(app_->add_option_function<int>(
                        name, [set](const int& index) { set(index); }, what)
                    ->type_name(kChoiceType)
                    ->transform(index_of(words))
                    ->option_text(CLI::detail::join(words, "|") + " [" + otherwise + "]"));
}

Option CommandParser::choices_of(const std::string& name,
                                 const std::function<void(const std::vector<int>&)>& set,
                                 const std::vector<std::string>& words, const std::string& what) {
  return Option(app_->add_option_function<std::vector<int>>(name, set, what)
                    ->type_name(kChoiceType)
                    ->delimiter(',')
                    ->transform(index_of(words))
                    ->option_text("NAME[,NAME..] [" + CLI::detail::join(words, ",") + "]"));
}

bool CommandParser::parsed() const { return app_->parsed(); }

bool CommandParser::given(const std::string& name) const {
  return app_->get_option(name)->count() > 0;
}

ProgramParser::ProgramParser(const Texts& texts)
    : app_(std::make_unique<CLI::App>(texts.what, texts.name)) {
  app_->set_version_flag("--version", texts.version);
  app_->require_subcommand(0, 1);
  app_->footer(texts.footer);
}

ProgramParser::~ProgramParser() = default;

bool ProgramParser::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    return true;
  } catch (const CLI::Success& answered) {
    app_->exit(answered);
    return false;
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string(error.what()) + " (see bentaxis --help)");
  }
}

}  // namespace bentaxis::cli
