# The description of a unit and its archive, for the program. Carries the pump of a unit with it: the list of
# variables is what that has.
bentaxis_library(fmu STANDARD 20
  SOURCES archive.cpp dependencies.cpp description_fmi2.cpp description_fmi3.cpp description_parts.cpp documentation.cpp
    embedded.cpp package.cpp platforms.cpp sampler.cpp terminals.cpp units.cpp $<TARGET_OBJECTS:bentaxis_fmu_plant>)
target_link_libraries(bentaxis_fmu PUBLIC bentaxis::pump
  PRIVATE bentaxis::analytic bentaxis::coupled bentaxis::files bentaxis::hydraulics bentaxis::results
    pugixml::pugixml zip)
target_compile_definitions(bentaxis_fmu PRIVATE BENTAXIS_VERSION="${PROJECT_VERSION}")
bentaxis_compile_fast(bentaxis_fmu)
bentaxis_join_sources(bentaxis_fmu 5)
set_source_files_properties(description_fmi3.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # it has the names of description_fmi2.cpp

# Libraries for further platforms, where scripts/build_fmu_platforms has built them.
install(DIRECTORY ${PROJECT_BINARY_DIR}/modules/fmu DESTINATION ${CMAKE_INSTALL_LIBDIR}/bentaxis OPTIONAL)

# What the archive carries: the library of the unit, the licence, and those of what is joined to the library.
set(library ${CMAKE_CURRENT_BINARY_DIR}/bentaxis_fmu.so)
add_dependencies(bentaxis_fmu bentaxis_fmu_library)
set(notices ${CMAKE_CURRENT_BINARY_DIR}/third_party.txt)
bentaxis_write_notices(fmu ${notices})
set_source_files_properties(embedded.cpp PROPERTIES
  OBJECT_DEPENDS "${library};${notices};${PROJECT_SOURCE_DIR}/LICENSE"
  COMPILE_DEFINITIONS "BENTAXIS_FMU_LIBRARY=\"${library}\";BENTAXIS_FMU_NOTICES=\"${notices}\";BENTAXIS_FMU_LICENCE=\"${PROJECT_SOURCE_DIR}/LICENSE\"")
