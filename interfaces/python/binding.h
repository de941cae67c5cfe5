// The parts of the module: each adds its classes and functions.
#pragma once

#include <pybind11/pybind11.h>

namespace bentaxis::python {

void add_errors(pybind11::module_& module);
void add_tables(pybind11::module_& module);
void add_case(pybind11::module_& module);
void add_runs(pybind11::module_& module);
void add_simulation(pybind11::module_& module);
void add_comparison(pybind11::module_& module);
void add_regression(pybind11::module_& module);
void add_sweep(pybind11::module_& module);
void add_optimisation(pybind11::module_& module);
void add_identification(pybind11::module_& module);

}  // namespace bentaxis::python
