# What find_package(bernal) needs; each library installs itself, see src/CMakeLists.txt.
include(CMakePackageConfigHelpers)

set(config ${CMAKE_INSTALL_LIBDIR}/cmake/bernal)
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/bernal-config.cmake.in ${PROJECT_BINARY_DIR}/bernal-config.cmake
  INSTALL_DESTINATION ${config})
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/bernal-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/bernal-config.cmake ${PROJECT_BINARY_DIR}/bernal-config-version.cmake
  ${PROJECT_SOURCE_DIR}/cmake/bernal_components.cmake
  DESTINATION ${config} COMPONENT development)

# For editors and programs: what a scene may say and what report.json says.
install(FILES
  ${PROJECT_SOURCE_DIR}/data/schemas/scene.schema.json ${PROJECT_SOURCE_DIR}/data/schemas/report.schema.json
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bernal/schemas COMPONENT command)
