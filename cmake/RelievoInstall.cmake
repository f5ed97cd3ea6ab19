# Installs the library, its headers, the program, and what CMake and pkg-config need to find them.
# Every path is relative to the prefix, so that an installed tree can be moved.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/relievo)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(TARGETS relievo EXPORT relievoTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/sdk/include/relievo DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp")
install(FILES ${PROJECT_SOURCE_DIR}/sdk/include/relievo.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET relievo_cli)
  file(RELATIVE_PATH lib_from_bin /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
  set_target_properties(relievo_cli PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}")
  set_target_properties(relievo_cli PROPERTIES EXPORT_NAME relievo_program)
  install(TARGETS relievo_cli EXPORT relievoTargets RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  # A project that has us as a subfolder calls relievo_add_shaders as well.
  add_executable(relievo::relievo_program ALIAS relievo_cli)
  include(relievo_add_shaders)
endif()

install(EXPORT relievoTargets NAMESPACE relievo:: DESTINATION ${package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/relievoConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/relievoConfig.cmake INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor version may change interfaces.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/relievoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/relievoConfig.cmake ${PROJECT_BINARY_DIR}/relievoConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/relievo_add_shaders.cmake
        DESTINATION ${package_dir})

file(RELATIVE_PATH RELIEVO_PREFIX_FROM_PC /${pkgconfig_dir} /)
string(REGEX REPLACE "/$" "" RELIEVO_PREFIX_FROM_PC "${RELIEVO_PREFIX_FROM_PC}")
configure_file(${CMAKE_CURRENT_LIST_DIR}/relievo.pc.in ${PROJECT_BINARY_DIR}/relievo.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/relievo.pc DESTINATION ${pkgconfig_dir})

# A consumer without sanitizers cannot link a library that has them.
if(RELIEVO_BUILD_TESTS AND NOT RELIEVO_SANITIZE AND NOT RELIEVO_COVERAGE)
  add_test(NAME InstalledPackage.IsConsumed COMMAND ${PROJECT_SOURCE_DIR}/tests/install/run.sh ${PROJECT_BINARY_DIR})
  set_tests_properties(InstalledPackage.IsConsumed PROPERTIES LABELS install TIMEOUT 600)
  add_test(NAME InstalledPackage.BuildsShaders COMMAND ${PROJECT_SOURCE_DIR}/tests/install/shaders.sh ${PROJECT_BINARY_DIR})
  set_tests_properties(InstalledPackage.BuildsShaders PROPERTIES LABELS install TIMEOUT 600)
endif()
