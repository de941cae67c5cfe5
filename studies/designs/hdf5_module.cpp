#include "hdf5_module.h"

namespace {

void ids(bentaxis::designs::Hdf5Ids* found) {
  *found = {H5P_GROUP_CREATE, H5P_DATASET_CREATE, H5P_FILE_CREATE, H5T_IEEE_F64LE,
            H5T_STD_U64LE,    H5T_NATIVE_DOUBLE,  H5T_C_S1,        H5F_ACC_TRUNC};
}

}  // namespace

extern "C" {
const bentaxis::designs::Hdf5Functions kBentaxisHdf5 = {H5dont_atexit,
                                                        ids,
                                                        H5Aclose,
                                                        H5Acreate2,
                                                        H5Awrite,
                                                        H5Dclose,
                                                        H5Dcreate2,
                                                        H5Dget_space,
                                                        H5Dwrite,
                                                        H5Eset_auto2,
                                                        H5Fclose,
                                                        H5Fcreate,
                                                        H5Fflush,
                                                        H5Gclose,
                                                        H5Gcreate2,
                                                        H5Gopen2,
                                                        H5Pclose,
                                                        H5Pcreate,
                                                        H5Pset_chunk,
                                                        H5Pset_deflate,
                                                        H5Pset_link_creation_order,
                                                        H5Pset_obj_track_times,
                                                        H5Pset_shuffle,
                                                        H5Sclose,
                                                        H5Screate,
                                                        H5Screate_simple,
                                                        H5Sselect_hyperslab,
                                                        H5Tclose,
                                                        H5Tcopy,
                                                        H5Tis_variable_str,
                                                        H5Tset_cset,
                                                        H5Tset_size};
}
