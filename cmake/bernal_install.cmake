# install, and what find_package(bernal) needs.
include(CMakePackageConfigHelpers)

install(TARGETS bernal_core bernal_predict bernal_cad bernal_bernal
        EXPORT bernal-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/bernal DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT bernal-targets NAMESPACE bernal:: FILE bernal-targets.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/bernal)
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/bernal-config.cmake.in ${PROJECT_BINARY_DIR}/bernal-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/bernal)
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/bernal-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/bernal-config.cmake ${PROJECT_BINARY_DIR}/bernal-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/bernal)
