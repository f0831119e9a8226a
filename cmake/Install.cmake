# SPDX-License-Identifier: GPL-3.0-or-later
# `find_package(sunder)` for users of the library: headers keep their folders under include/sunder.
include(CMakePackageConfigHelpers)

# The public headers: what a user includes, and what those include. The others may change any time.
set(sunder_meshing_headers error field lattice model_surface parallel progress random raw_vector
                           region repair surface_defects tri_mesh triangulate trig vec)
set(sunder_fracture_headers asset bonds breaking chunk_mesh cut local_web hulls measure pattern quad_grid
                            recover sites slivers solid_asset solid_model solid_prepare spiderweb
                            support_graph voronoi wall)
set(sunder_sim_headers blow buckling collapse frame impact joint_strength material penetration pose
                      post_stability projectile recording rigid_world section simulation_params spin)
set(sunder_io_headers collapse_report collapse_scene export export_recording impact_report
                      impact_scene import joint_history json_lines model output page png report
                      report_page error_front run_report scene text_writer)
foreach(layer meshing fracture sim io)
  foreach(header ${sunder_${layer}_headers})
    install(FILES ${PROJECT_SOURCE_DIR}/${layer}/${header}.hpp
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sunder/${layer})
  endforeach()
endforeach()
install(TARGETS sunder sunder_meshing sunder_fracture sunder_sim sunder_io sunder_command
        EXPORT sunder-targets)
install(EXPORT sunder-targets NAMESPACE sunder:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sunder)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sunder-config.cmake.in
  ${PROJECT_BINARY_DIR}/sunder-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sunder)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sunder-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sunder-config.cmake
              ${PROJECT_BINARY_DIR}/sunder-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sunder)
