// Tables in pickles.
#pragma once

#include <pybind11/pybind11.h>

#include "table.h"

namespace bentaxis::python {

/// All that a table shows, a copy.
pybind11::tuple state_of(const Table& table);
/// The table of such a state.
Table table_in(const pybind11::tuple& state);

}  // namespace bentaxis::python
