# cpack: one .deb with program, library, headers, data, manual, completions and documents (scripts/make_package).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME bentaxis)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "Computes every reaction force and the drive torque of a bent-axis axial piston pump twice,
by a closed-form model and by a multibody model, and reports where and by how much
they differ. Program, C++ library, Python module, cases and reference data.")
# The project has neither an address nor a home page of its own: whoever distributes the package names theirs.
set(BENTAXIS_PACKAGE_CONTACT "bentaxis developers" CACHE STRING
  "Maintainer of the package, as Debian writes it: name <address>")
set(BENTAXIS_PACKAGE_HOMEPAGE "" CACHE STRING "Home page of whoever distributes the package; empty: none")
set(CPACK_PACKAGE_CONTACT "${BENTAXIS_PACKAGE_CONTACT}")
if(BENTAXIS_PACKAGE_HOMEPAGE)
  set(CPACK_DEBIAN_PACKAGE_HOMEPAGE "${BENTAXIS_PACKAGE_HOMEPAGE}")
endif()
# Debian's changelog: this version, and where its changes are listed. SOURCE_DATE_EPOCH sets the date.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(maintainer "${BENTAXIS_PACKAGE_CONTACT}")
if(NOT maintainer MATCHES "<.*>$")
  string(APPEND maintainer " <>")
endif()
set(changelog ${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian)
file(WRITE ${changelog} "bentaxis (${PROJECT_VERSION}) bookworm; urgency=medium

  * Version ${PROJECT_VERSION}. Its changes are listed in
    /usr/share/doc/bentaxis/CHANGELOG.md.

 -- ${maintainer}  ${date}
")
execute_process(COMMAND gzip -9nf ${changelog} COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${changelog}.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/package)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
# What is linked is added by the script; librsvg is loaded when a PNG is wanted.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/scripts/cmake/package_depends.cmake)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "librsvg2-2")
if(BENTAXIS_PYTHON)
  set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/scripts/cmake/prerm)
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", python3 (>= 3.11), python3-numpy")
endif()
# For those who build programs with the library: what its headers' users link.
file(STRINGS ${PROJECT_SOURCE_DIR}/scripts/packages.txt libraries REGEX "^libraries ")
list(TRANSFORM libraries REPLACE "^libraries " "")
list(JOIN libraries ", " CPACK_DEBIAN_PACKAGE_SUGGESTS)
include(CPack)
