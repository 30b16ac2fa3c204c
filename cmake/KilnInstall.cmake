# SPDX-License-Identifier: GPL-3.0-or-later
# Rules of `make install` and `make package`: programs, the runtime as libraries, shaders, licences.
include(CMakePackageConfigHelpers)

set(KILN_PROGRAMS kiln kiln-check kiln-export kiln-serve kiln-spectrum kiln-web-export ${stage_programs} kiln-render kiln-shade kiln-view)
install(TARGETS ${KILN_PROGRAMS} RUNTIME)
install(TARGETS kiln-runtime kiln-runtime-gl kiln-runtime-scene EXPORT kilnTargets LIBRARY)
install(TARGETS kiln-openimageio LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/kiln)
install(DIRECTORY runtime/include/kiln TYPE INCLUDE)
install(DIRECTORY shaders/ DESTINATION ${CMAKE_INSTALL_DATADIR}/kiln/shaders
        FILES_MATCHING PATTERN "common_*" PATTERN "render_*")
install(FILES LICENSE LICENSES/MIT.txt README.md TYPE DOC)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.csv")
install(DIRECTORY examples TYPE DOC)

# Man pages and completions, made from the programs' own option tables.
set(pages "")
foreach(program ${KILN_PROGRAMS})
  set(man ${PROJECT_BINARY_DIR}/share/${program}.1)
  set(bash ${PROJECT_BINARY_DIR}/share/${program})
  set(zsh ${PROJECT_BINARY_DIR}/share/_${program})
  add_custom_command(OUTPUT ${man} ${bash} ${zsh}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/share
    COMMAND ${program} --help-as man > ${man}
    COMMAND ${program} --help-as bash > ${bash}
    COMMAND ${program} --help-as zsh > ${zsh}
    DEPENDS ${program} VERBATIM)
  list(APPEND pages ${man})
  install(FILES ${man} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${bash} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${zsh} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
endforeach()
add_custom_target(pages ALL DEPENDS ${pages})

# CMake package: find_package(kiln) defines kiln::runtime, kiln::runtime-gl and kiln::runtime-scene.
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/kiln)
install(EXPORT kilnTargets NAMESPACE kiln:: DESTINATION ${package_folder})
configure_package_config_file(cmake/kilnConfig.cmake.in ${PROJECT_BINARY_DIR}/kilnConfig.cmake
  INSTALL_DESTINATION ${package_folder} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/kilnConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/kilnConfig.cmake ${PROJECT_BINARY_DIR}/kilnConfigVersion.cmake DESTINATION ${package_folder})

file(RELATIVE_PATH PREFIX_OF_PKG_CONFIG ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
function(kiln_pkg_config PC_NAME PC_DESCRIPTION PC_REQUIRES)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/kiln-runtime.pc.in ${PROJECT_BINARY_DIR}/${PC_NAME}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${PC_NAME}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
kiln_pkg_config(kiln-runtime "Loads and relights assets that Kiln baked" "")
kiln_pkg_config(kiln-runtime-scene "Moves scenes of assets that Kiln baked, which shadow each other" "Requires: kiln-runtime")
kiln_pkg_config(kiln-runtime-gl "Draws assets that Kiln baked, by OpenGL 4.5" "Requires: kiln-runtime")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Kiln developers <kiln@localhost>")
set(CPACK_PACKAGE_FILE_NAME kiln_${PROJECT_VERSION}_${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_DEPENDS colord-data)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)
set(CPACK_STRIP_FILES ON)
include(CPack)
