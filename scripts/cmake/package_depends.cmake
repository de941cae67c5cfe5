# Run by cpack once the package's files are in place: the libraries that its programs and modules link, as Debian packages.
# CPACK_DEBIAN_PACKAGE_SHLIBDEPS does the same, but starts two programs for each file of the package to find those that link:
# for 2900 files minutes.
file(GLOB_RECURSE files LIST_DIRECTORIES false ${CPACK_TEMPORARY_DIRECTORY}/*)
set(linking "")
foreach(path IN LISTS files)
  file(READ ${path} magic LIMIT 4 HEX)
  if(magic STREQUAL "7f454c46")  # ELF; objects are in archives
    list(APPEND linking ${path})
  endif()
endforeach()
# Where dpkg-shlibdeps works it wants a package's sources (debian/control) and its root (DEBIAN/), for libraries within it.
set(folder ${CPACK_TEMPORARY_DIRECTORY})
file(WRITE ${folder}/debian/control "")
file(MAKE_DIRECTORY ${folder}/DEBIAN)
execute_process(COMMAND dpkg-shlibdeps --ignore-missing-info -O ${linking} WORKING_DIRECTORY ${folder}
  OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${folder}/debian ${folder}/DEBIAN)
if(NOT found MATCHES "^shlibs:Depends=(.+)$")
  message(FATAL_ERROR "dpkg-shlibdeps names no libraries: ${found}")
endif()
string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", ${CMAKE_MATCH_1}")
