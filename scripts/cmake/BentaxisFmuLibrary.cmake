# The library of an FMU for another platform, and nothing else (scripts/build_fmu_platforms). Headers that are the same on
# every platform are this machine's; SUNDIALS is one that was built for the platform (SUNDIALS_DIR).
find_package(SUNDIALS 6 REQUIRED)
set(headers ${PROJECT_BINARY_DIR}/headers)  # and not all of /usr/include, which has those of this machine's C library
file(MAKE_DIRECTORY ${headers})
foreach(name boost libfccp toml++)
  file(CREATE_LINK /usr/include/${name} ${headers}/${name} SYMBOLIC)
endforeach()
include_directories(SYSTEM ${headers})
add_library(Eigen3::Eigen INTERFACE IMPORTED)
target_include_directories(Eigen3::Eigen INTERFACE /usr/include/eigen3)

add_subdirectory(core/pump pump)
add_subdirectory(core/results results)
add_subdirectory(core/numerics numerics)
add_subdirectory(analytic)
add_subdirectory(hydraulics)
add_subdirectory(coupled)
add_subdirectory(interfaces/fmu fmu)
