# SPDX-License-Identifier: GPL-3.0-or-later
# `find_package(sunder)` for users of the library: headers keep their folders under include/sunder.
include(CMakePackageConfigHelpers)

foreach(layer meshing fracture io)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${layer}/*.hpp)
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sunder/${layer})
endforeach()
install(TARGETS sunder sunder_meshing sunder_fracture sunder_io sunder_command EXPORT sunder-targets)
install(EXPORT sunder-targets NAMESPACE sunder:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sunder)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sunder-config.cmake.in
  ${PROJECT_BINARY_DIR}/sunder-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sunder)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sunder-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sunder-config.cmake
              ${PROJECT_BINARY_DIR}/sunder-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sunder)
