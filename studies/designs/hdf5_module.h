// What is used of the library HDF5, by the module that is linked with it.
#pragma once

#include <hdf5.h>

namespace bentaxis::designs {

/// Numbers by which the library knows its types and lists of properties.
struct Hdf5Ids {
  hid_t group_creation;
  hid_t data_set_creation;
  hid_t file_creation;
  hid_t stored_double;
  hid_t stored_integer;
  hid_t native_double;
  hid_t text;
  unsigned overwrite;  ///< how a file is opened
};

/// Functions by their names without "H5".
struct Hdf5Functions {
  decltype(&H5dont_atexit) dont_atexit;
  void (*ids)(Hdf5Ids*);  ///< starts the library
  decltype(&H5Aclose) Aclose;
  decltype(&H5Acreate2) Acreate2;
  decltype(&H5Awrite) Awrite;
  decltype(&H5Dclose) Dclose;
  decltype(&H5Dcreate2) Dcreate2;
  decltype(&H5Dget_space) Dget_space;
  decltype(&H5Dwrite) Dwrite;
  decltype(&H5Eset_auto2) Eset_auto2;
  decltype(&H5Fclose) Fclose;
  decltype(&H5Fcreate) Fcreate;
  decltype(&H5Fflush) Fflush;
  decltype(&H5Gclose) Gclose;
  decltype(&H5Gcreate2) Gcreate2;
  decltype(&H5Gopen2) Gopen2;
  decltype(&H5Pclose) Pclose;
  decltype(&H5Pcreate) Pcreate;
  decltype(&H5Pset_chunk) Pset_chunk;
  decltype(&H5Pset_deflate) Pset_deflate;
  decltype(&H5Pset_link_creation_order) Pset_link_creation_order;
  decltype(&H5Pset_obj_track_times) Pset_obj_track_times;
  decltype(&H5Pset_shuffle) Pset_shuffle;
  decltype(&H5Sclose) Sclose;
  decltype(&H5Screate) Screate;
  decltype(&H5Screate_simple) Screate_simple;
  decltype(&H5Sselect_hyperslab) Sselect_hyperslab;
  decltype(&H5Tclose) Tclose;
  decltype(&H5Tcopy) Tcopy;
  decltype(&H5Tis_variable_str) Tis_variable_str;
  decltype(&H5Tset_cset) Tset_cset;
  decltype(&H5Tset_size) Tset_size;
};

}  // namespace bentaxis::designs

extern "C" {
extern const bentaxis::designs::Hdf5Functions kBentaxisHdf5;
}
