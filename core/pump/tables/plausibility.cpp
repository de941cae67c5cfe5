// [plausibility].
#include "tables/entries.h"

namespace bentaxis::tables {

Table plausibility_table() {
  return {.name = "plausibility",
          .meaning = "reasons for values that a check holds to be doubtful (plausibility.md)",
          .presence = Presence::silent,
          .parameters = {text("meant", FIELD(c.meant),
                              "`CODE: reason; CODE: reason`: these are meant, and do not warn")}};
}

}  // namespace bentaxis::tables
