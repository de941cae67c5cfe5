// [plausibility].
#include "tables/entries.h"

namespace bentaxis::tables {

Table plausibility_table() {
  return {.name = "plausibility",
          .meaning = "reasons for values that a plausibility check warns of (plausibility.md)",
          .presence = Presence::silent,
          .parameters = {
              text("meant", FIELD(c.meant),
                   "`CODE: reason; CODE: reason`: these values are intended and do not warn")}};
}

}  // namespace bentaxis::tables
