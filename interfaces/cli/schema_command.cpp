// bentaxis schema: the format of case files.
#include "bentaxis/files/schema.h"
#include "bentaxis/study/plausibility.h"
#include "command_tools.h"

namespace bentaxis::cli {

Command add_schema_command(CommandParser program) {
  auto command = program.subcommand(
      "schema", "Print the JSON Schema of case files, for editors that complete and check TOML");
  const auto tables = std::make_shared<std::vector<std::string>>();
  command.option("--markdown", *tables, "TABLE..",
                 "print the keys of these tables as Markdown tables instead (docs/case_file.md); "
                 "top means the "
                 "keys above all tables, checks the plausibility checks");
  return {command, [tables] {
            std::string text;
            for (const std::string& table : *tables)
              text += (text.empty() ? "" : "\n") +
                      (table == "checks" ? study::plausibility_markdown()
                                         : markdown_table(table == "top" ? "" : table));
            if (tables->empty()) text = case_schema();
            std::fputs(text.c_str(), stdout);
            return kDone;
          }};
}

}  // namespace bentaxis::cli
