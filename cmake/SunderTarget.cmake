# SPDX-License-Identifier: GPL-3.0-or-later
# Flags that every target of the tree shares, each with its reason.
function(sunder_options target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
    -ffp-contract=off  # the same bits with and without FMA instructions
  )
  if(SUNDER_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(SUNDER_SANITIZE)
    target_compile_options(${target} PRIVATE
      -fsanitize=${SUNDER_SANITIZE} -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${SUNDER_SANITIZE})
  endif()
endfunction()

# A layer of the library: sunder_<layer>, known to users as sunder::<layer>. Includes are written
# from the root of the tree, so the layers below are visible by their folder's name.
function(sunder_layer layer)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(sunder_${layer} STATIC ${ARG_SOURCES})
  add_library(sunder::${layer} ALIAS sunder_${layer})
  set_target_properties(sunder_${layer} PROPERTIES EXPORT_NAME ${layer})
  target_include_directories(sunder_${layer} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/sunder>)
  target_compile_features(sunder_${layer} PUBLIC cxx_std_20)
  target_link_libraries(sunder_${layer} PUBLIC ${ARG_LINK} PRIVATE ${ARG_PRIVATE_LINK})
  sunder_options(sunder_${layer})
endfunction()

# CGAL's filtered predicates switch the rounding mode: the compiler must not move arithmetic
# across the switch. -O1 halves the time these files take to compile and costs nothing that shows.
function(sunder_cgal_sources)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS
    "-frounding-math;-Wno-conversion;-Wno-shadow;$<$<CONFIG:Debug,RelWithDebInfo>:-O1>")
endfunction()

# A module that is linked to a heavy library, loaded when first asked for, and put into a layer as a
# file (meshing/embedded_module.hpp): `source` exports sunder_<name>_module, the layer has the
# function <name>_file().
function(sunder_embedded_module layer name source)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  add_library(sunder_${name} MODULE ${source})
  target_include_directories(sunder_${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(sunder_${name} PRIVATE ${ARG_LINK})
  set_target_properties(sunder_${name} PROPERTIES
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  target_link_options(sunder_${name} PRIVATE -Wl,--strip-all)  # it is copied into every program
  sunder_options(sunder_${name})
  set(file ${CMAKE_CURRENT_BINARY_DIR}/libsunder_${name}.so)
  set(holder ${CMAKE_CURRENT_BINARY_DIR}/${name}_file.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/module_file.cpp.in ${holder} @ONLY)
  set_source_files_properties(${holder} PROPERTIES OBJECT_DEPENDS ${file})
  target_sources(sunder_${layer} PRIVATE ${holder})
  add_dependencies(sunder_${layer} sunder_${name})
endfunction()
