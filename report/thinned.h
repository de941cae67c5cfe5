// What a page shows of very many samples. Internal.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "bentaxis/report/document.h"

namespace bentaxis::report {

/// Rows that a page shows of the curves: evenly spread ones, and those at which a column, or a
/// difference, is smallest or largest. Rising. All of them where there are no more than `most`.
std::vector<std::size_t> rows_shown(const Curves& curves, std::size_t most);

/// A document and its curves with some of the rows alone: the page's own curves, what figures draw
/// over the same angles, and the pump in space.
struct Thinned {
  Document document;
  Curves curves;
};
Thinned thinned(const Document& document, const Curves& curves,
                const std::vector<std::size_t>& rows);

}  // namespace bentaxis::report
