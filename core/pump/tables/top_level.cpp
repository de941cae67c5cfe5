// The keys above all tables.
#include "tables/entries.h"

namespace bentaxis::tables {

Table top_level() {
  return {.name = "",
          .meaning = "the file itself",
          .parameters = {number("schema", "", IntegerField{}, kNoUnit, {1, 1}, kRequired,
                                "version of this format"),
                         required_text("name", FIELD(c.name), "shown in reports")}};
}

}  // namespace bentaxis::tables
