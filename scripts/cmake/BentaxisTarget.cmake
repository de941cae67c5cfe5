# What every target of the project has in common: standard, warnings as errors, include path.
option(BENTAXIS_SANITIZE "Build with address and undefined-behaviour sanitizers" OFF)
set(BENTAXIS_SANITIZE_LESS "" CACHE STRING "Checks of the undefined-behaviour sanitizer that are left out")
option(BENTAXIS_SANITIZE_THREAD "Build with the thread sanitizer" OFF)
option(BENTAXIS_WARNINGS_AS_ERRORS "A warning ends the build" ON)
option(BENTAXIS_BUILD_FUZZERS "Build the libFuzzer programs (clang only)" OFF)

function(bentaxis_target name standard)
  target_compile_features(${name} PRIVATE cxx_std_${standard})
  target_compile_options(${name} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion $<$<BOOL:${BENTAXIS_WARNINGS_AS_ERRORS}>:-Werror>
    # GCC 12 sees overlapping copies in std::string concatenation where there are none (PR 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  if(BENTAXIS_SANITIZE)
    target_compile_options(${name} PRIVATE -fsanitize=address,undefined -fno-sanitize-recover=all
      -fno-omit-frame-pointer)
    if(BENTAXIS_SANITIZE_LESS)
      target_compile_options(${name} PRIVATE -fno-sanitize=${BENTAXIS_SANITIZE_LESS})
    endif()
    target_link_options(${name} PUBLIC -fsanitize=address,undefined)
  endif()
  if(BENTAXIS_SANITIZE OR BENTAXIS_SANITIZE_THREAD)
    # Instrumented code is too tangled for these warnings; what they mean is found at run time.
    target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized;-Wno-maybe-uninitialized>)
  endif()
  if(BENTAXIS_SANITIZE_THREAD)
    target_compile_options(${name} PRIVATE -fsanitize=thread -fno-omit-frame-pointer)
    target_link_options(${name} PUBLIC -fsanitize=thread)
  endif()
  if(BENTAXIS_BUILD_FUZZERS)
    target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

# A module is a folder: include/bentaxis/MODULE/ is what others see (and what is
# installed), everything beside it is the module's own. A target finds the headers of what it links and no
# others, so that what is not in target_link_libraries cannot be included.
#   bentaxis_library(<module> STANDARD <17|20> [FOLDERS <folder>..] SOURCES ...)    folders: where it lies in several
function(bentaxis_library module)
  cmake_parse_arguments(ARG "" "STANDARD" "SOURCES;FOLDERS" ${ARGN})
  set(name bentaxis_${module})
  add_library(${name} STATIC ${ARG_SOURCES})
  add_library(bentaxis::${module} ALIAS ${name})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${module})
  bentaxis_target(${name} ${ARG_STANDARD})
  if(NOT ARG_FOLDERS)
    set(ARG_FOLDERS .)
  endif()
  foreach(folder IN LISTS ARG_FOLDERS)
    cmake_path(ABSOLUTE_PATH folder NORMALIZE)
    cmake_path(APPEND folder include OUTPUT_VARIABLE headers)
    target_include_directories(${name}
      PUBLIC $<BUILD_INTERFACE:${headers}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
      PRIVATE ${folder})
    install(DIRECTORY ${headers}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
  endforeach()
  # A component of find_package(bentaxis) of its own.
  install(TARGETS ${name} EXPORT bentaxis_${module} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT bentaxis_${module} NAMESPACE bentaxis:: FILE bentaxis-${module}.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/bentaxis)
  set_property(GLOBAL APPEND PROPERTY BENTAXIS_MODULES ${module})
endfunction()

# What is linked with a large library is a file of its own, loaded when it is wanted (files/module_folders.h):
#   bentaxis_module(<name> FOR <target> SOURCES <source>.. LIBRARIES <library>.. [ALL_NEEDED])
# ALL_NEEDED: also libraries that none of its calls needs, as C's own where it only hands functions on.
function(bentaxis_module name)
  cmake_parse_arguments(ARG "ALL_NEEDED" "FOR" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${name} MODULE ${ARG_SOURCES})
  bentaxis_target(${name} 20)
  set_target_properties(${name} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/modules)
  if(ARG_ALL_NEEDED)
    target_link_options(${name} PRIVATE LINKER:--no-as-needed)
  endif()
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES})
  add_dependencies(${ARG_FOR} ${name})
  install(TARGETS ${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/bentaxis)
endfunction()

# Several modules under one name: what programs written for 1.0.0 link.
#   bentaxis_umbrella(<name> <target>..)
function(bentaxis_umbrella module)
  set(name bentaxis_${module})
  add_library(${name} INTERFACE)
  add_library(bentaxis::${module} ALIAS ${name})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${module})
  target_link_libraries(${name} INTERFACE ${ARGN})
  install(TARGETS ${name} EXPORT bentaxis_${module})
  install(EXPORT bentaxis_${module} NAMESPACE bentaxis:: FILE bentaxis-${module}.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/bentaxis)
  set_property(GLOBAL APPEND PROPERTY BENTAXIS_MODULES ${module})
endfunction()

# A source that uses SUNDIALS, as an object with SUNDIALS joined to it statically and out of sight
# (scripts/cmake/isolate.cmake says why). It sees the headers of its module alone. Where Simbody is not built in, SUNDIALS
# is linked as usual: <variable>_needs has its libraries.
#   bentaxis_with_sundials(<target> <source> <variable that receives the object>)
function(bentaxis_with_sundials name source variable)
  set(sundials SUNDIALS::cvodes_static SUNDIALS::nvecserial_static SUNDIALS::sunmatrixdense_static
    SUNDIALS::sunlinsoldense_static)
  set(archives "")
  foreach(library IN LISTS sundials)
    list(APPEND archives $<TARGET_FILE:${library}>)
  endforeach()
  set(kind STATIC)
  if(BENTAXIS_ONLY_FMU_LIBRARY)
    set(kind OBJECT)
  endif()
  add_library(${name} ${kind} ${source})
  bentaxis_target(${name} 20)
  target_link_libraries(${name} PRIVATE ${sundials})
  target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/include)
  if(BENTAXIS_ONLY_FMU_LIBRARY)
    set(${variable} $<TARGET_OBJECTS:${name}> PARENT_SCOPE)
    set(${variable}_needs ${sundials} PARENT_SCOPE)
    return()
  endif()
  set(isolated ${CMAKE_CURRENT_BINARY_DIR}/${name}_with_sundials.o)
  add_custom_command(
    OUTPUT ${isolated}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${isolated} -DARCHIVE=$<TARGET_FILE:${name}>
      "-DLIBRARIES=${archives}" -DLINKER=${CMAKE_LINKER} -DNM=${CMAKE_NM} -DOBJCOPY=${CMAKE_OBJCOPY}
      -P ${PROJECT_SOURCE_DIR}/scripts/cmake/isolate.cmake
    DEPENDS ${name} ${PROJECT_SOURCE_DIR}/scripts/cmake/isolate.cmake
    COMMENT "Hiding SUNDIALS from Simbody" VERBATIM)
  set_source_files_properties(${isolated} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
  set(${variable} ${isolated} PARENT_SCOPE)
endfunction()

# For what runs once a command and is long to compile (documents, JSON, option parsing): less optimisation
# costs nothing there. Never for what computes at angles. With sanitizers, whose builds are mostly compiling: none.
#   bentaxis_compile_fast(<target> [<source>...])    all of the target, or these sources of it
function(bentaxis_compile_fast target)
  set(level $<$<CONFIG:Release>:-O1>)
  if(BENTAXIS_SANITIZE OR BENTAXIS_SANITIZE_THREAD)
    set(level -O0)
  endif()
  if(ARGN)
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS ${level})
  else()
    target_compile_options(${target} PRIVATE ${level})
  endif()
endfunction()

# For modules of many short sources behind long headers: the compiler reads the headers once for several sources.
# Off for tools that look at single sources (scripts/check_tidy).
option(BENTAXIS_JOIN_SOURCES "Compile several sources of a module at a time" ON)
function(bentaxis_join_sources target count)
  if(BENTAXIS_JOIN_SOURCES)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${count})
    # A source may keep what is of types of its own; joined, GCC takes it for a header. Builds of single sources warn.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# For tests that look inside a module: its internal headers too.
function(bentaxis_see_inside target module)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/${module})
endfunction()

# For sources that include Simbody. Debian builds Simbody without NDEBUG, and the layout of classes
# in its headers depends on it. The two warnings are false alarms of GCC 12 about Simbody's strided
# vectors, after inlining.
set(BENTAXIS_SIMBODY_OPTIONS -UNDEBUG
  $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-maybe-uninitialized>)
