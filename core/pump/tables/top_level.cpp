// The keys above all tables.
#include "tables/entries.h"

namespace bentaxis::tables {

Table top_level() {
  return {.name = "",
          .meaning = "the file itself",
          .parameters = {{.key = "schema",
                          .field = IntegerField{},
                          .range = {1, 1},
                          .meaning = "version of this format"},
                         {.key = "name", .field = FIELD(c.name), .meaning = "shown in reports"}}};
}

}  // namespace bentaxis::tables
