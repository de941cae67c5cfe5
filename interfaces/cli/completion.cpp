#include "completion.h"

#include <algorithm>

namespace bentaxis::cli {
namespace {

using Kind = Completion::Kind;

// Values as the help text has them tell files from folders and from what has to be typed.
Kind kind_of(const std::string& values) {
  const auto has = [&](const char* word) { return values.find(word) != std::string::npos; };
  if (has("DIR")) return Kind::folders;
  return has("FILE") || has("CASE") || has(".csv") ? Kind::files : Kind::nothing;
}

// @param before  what stands before the value in the same word: "--model="
Completion values_of(const OptionInfo& option, const std::string& before,
                     const std::string& begun) {
  const Kind kind = before.empty() ? kind_of(option.values) : Kind::nothing;
  if (option.words.empty()) return {kind, {}};
  Completion result{kind == Kind::files ? kind : Kind::words, {}};  // names of cases beside files
  const std::size_t comma = option.takes_several ? begun.rfind(',') : std::string::npos;
  const std::string list = comma == std::string::npos ? "" : begun.substr(0, comma + 1);
  for (const std::string& word : option.words)
    if ((list + word).starts_with(begun)) result.words.emplace_back(before + list + word, "");
  return result;
}

const OptionInfo* option_called(const CommandInfo& command, const std::string& name) {
  for (const OptionInfo& option : command.options)
    if (std::count(option.names.begin(), option.names.end(), name) > 0) return &option;
  return nullptr;
}

const OptionInfo* argument_of(const CommandInfo& command, std::size_t index) {
  for (const OptionInfo& option : command.options)
    if (option.is_argument && index-- == 0) return &option;
  return nullptr;
}

Completion options_of(const CommandInfo& command, const std::string& begun) {
  Completion result{Kind::words, {}};
  for (const OptionInfo& option : command.options)
    if (!option.is_argument && option.names.back().starts_with(begun))
      result.words.emplace_back(option.names.back(), option.what);
  return result;
}

Completion commands_of(const CommandInfo& command, const std::string& begun) {
  Completion result{Kind::words, {}};
  for (const CommandInfo& one : command.commands)
    if (one.name.starts_with(begun)) result.words.emplace_back(one.name, one.what);
  return result;
}

}  // namespace

Completion complete(const CommandInfo& program, const std::vector<std::string>& typed) {
  const CommandInfo* command = &program;
  const OptionInfo* waiting = nullptr;  // for its value
  std::size_t arguments = 0;
  for (std::size_t i = 0; i + 1 < typed.size(); ++i) {
    const std::string& word = typed[i];
    if (waiting != nullptr) {
      waiting = nullptr;
    } else if (word.starts_with("-")) {
      const OptionInfo* option = option_called(*command, word);
      if (option != nullptr && option->takes_value) waiting = option;
    } else {
      const auto next = std::find_if(command->commands.begin(), command->commands.end(),
                                     [&](const CommandInfo& one) { return one.name == word; });
      if (next != command->commands.end())
        command = &*next;
      else
        ++arguments;
    }
  }
  const std::string last = typed.empty() ? "" : typed.back();
  if (waiting != nullptr) return values_of(*waiting, "", last);
  if (const auto equals = last.find('='); last.starts_with("--") && equals != std::string::npos) {
    const OptionInfo* option = option_called(*command, last.substr(0, equals));
    if (option == nullptr) return {};
    return values_of(*option, last.substr(0, equals + 1), last.substr(equals + 1));
  }
  if (last.starts_with("-")) return options_of(*command, last);
  if (!command->commands.empty()) return commands_of(*command, last);
  const OptionInfo* argument = argument_of(*command, arguments);
  return argument == nullptr ? Completion{} : values_of(*argument, "", last);
}

std::string completion_text(const Completion& completion) {
  const char* const kinds[] = {"nothing", "words", "files", "folders"};
  std::string text = std::string(kinds[static_cast<int>(completion.kind)]) + "\n";
  for (const auto& [word, what] : completion.words) text += word + "\t" + what + "\n";
  return text;
}

const std::vector<std::string>& completed_shells() {
  static const std::vector<std::string> shells = {"bash", "zsh", "fish"};
  return shells;
}

std::string completion_script(const std::string& shell) {
  // A word that ends in = is to be continued: no blank after it. Bash parts words at = and : too.
  if (shell == "bash")
    return R"(# bash completion of bentaxis; made by: bentaxis completion bash
_bentaxis() {
  local line=${COMP_LINE:0:COMP_POINT} typed answer last
  read -ra typed <<< "$line"
  [[ $line == *[[:space:]] ]] && typed+=("")
  last=${typed[-1]}
  mapfile -t answer < <("${typed[0]}" completion words -- "${typed[@]:1}" 2> /dev/null)
  COMPREPLY=()
  case ${answer[0]} in
    files)
      mapfile -t COMPREPLY < <(compgen -f -- "$last"); compopt -o filenames
      COMPREPLY+=("${answer[@]:1}")
      COMPREPLY=("${COMPREPLY[@]%%$'\t'*}") ;;
    folders) mapfile -t COMPREPLY < <(compgen -d -- "$last"); compopt -o filenames ;;
    words)
      COMPREPLY=("${answer[@]:1}")
      COMPREPLY=("${COMPREPLY[@]%%$'\t'*}")
      [[ ${COMPREPLY[0]} == *= ]] && compopt -o nospace
      COMPREPLY=("${COMPREPLY[@]#"${last%"${last##*[=:]}"}"}") ;;
  esac
}
complete -F _bentaxis bentaxis
)";
  if (shell == "zsh")
    return R"(#compdef bentaxis
# zsh completion of bentaxis; made by: bentaxis completion zsh
_bentaxis() {
  local -a answer found shown blank
  answer=("${(@f)$(${words[1]} completion words -- "${(@)words[2,CURRENT]}" 2> /dev/null)}")
  case $answer[1] in
    files)
      found=("${(@)${(@)answer[2,-1]}%%$'\t'*}")
      (( $#answer > 1 )) && compadd -a found
      _files ;;
    folders) _files -/ ;;
    words)
      found=("${(@)${(@)answer[2,-1]}%%$'\t'*}")
      shown=("${(@)answer[2,-1]//$'\t'/  }")
      [[ $found[1] == *= ]] && blank=(-S '')
      compadd $blank -l -d shown -a found ;;
  esac
}
if [[ $funcstack[1] == _bentaxis ]]; then _bentaxis "$@"; else compdef _bentaxis bentaxis; fi
)";
  return R"(# fish completion of bentaxis; made by: bentaxis completion fish
function __bentaxis_complete
  set -l typed (commandline -opc)
  set -l last (commandline -ct)
  set -l answer ($typed[1] completion words -- $typed[2..-1] "$last" 2> /dev/null)
  switch "$answer[1]"
    case files
      __fish_complete_path "$last"
      for word in $answer[2..-1]
        echo $word
      end
    case folders
      __fish_complete_directories "$last"
    case words
      printf '%s\n' $answer[2..-1]
  end
end
complete -c bentaxis -f -a '(__bentaxis_complete)'
)";
}

}  // namespace bentaxis::cli
