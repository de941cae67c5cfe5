// What a page shows of very many samples. Internal.
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "bentaxis/report/document.h"

namespace bentaxis::report {

/// Of curves with more rows than this a page shows some. A turn of a tenth of a degree is whole.
inline constexpr std::size_t kMostRows = 4000;

/// Rows that a page shows: evenly spread ones, and those at which a curve is smallest or largest.
class RowsShown {
 public:
  /// All of them where there are no more than `most`.
  RowsShown(std::size_t all, std::size_t most);
  void add(const Values& curve);
  std::vector<std::size_t> rows() const { return {rows_.begin(), rows_.end()}; }  ///< rising

 private:
  std::set<std::size_t> rows_;
};

/// Of columns and differences of the curves.
std::vector<std::size_t> rows_shown(const Curves& curves, std::size_t most);

Values some_of(const Values& values, const std::vector<std::size_t>& rows);

/// Curves with some of their rows alone; what has not a value at every row stays.
Curves thinned(const Curves& curves, const std::vector<std::size_t>& rows);
/// A document whose figures draw over the same angles, `all` of them, and whose pump in space
/// stands at them, with some of the rows alone.
Document thinned(const Document& document, std::size_t all, const std::vector<std::size_t>& rows);

}  // namespace bentaxis::report
