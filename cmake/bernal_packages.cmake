# Debian packages of what `cmake --install` installs, each of some of its components: bernal, libbernal-dev and, where
# the module of Python is built, python3-bernal. cmake/package builds and makes them; tests/packages/run tries them.
set(doc ${CMAKE_INSTALL_DATADIR}/doc)

# README, the guide and what they link lie below doc as they lie in the source, so that every link holds and every
# command of the guide works where "data" is; and the site, if pandoc of cmake/site-packages.txt is there.
install(FILES README.md DESTINATION ${doc}/bernal COMPONENT command)
install(FILES CITATION.cff DESTINATION ${doc}/bernal COMPONENT command OPTIONAL)
install(DIRECTORY data DESTINATION ${doc}/bernal COMPONENT command
  REGEX "/data/guide/site$" EXCLUDE PATTERN __pycache__ EXCLUDE)
find_program(BERNAL_PANDOC pandoc)
if(BERNAL_PANDOC AND NOT BERNAL_SANITIZE)
  file(GLOB_RECURSE pages CONFIGURE_DEPENDS data/* include/*.hpp)
  list(FILTER pages EXCLUDE REGEX "__pycache__")
  set(module)
  if(TARGET bernal_python_package)
    set(module bernal_python_package)  # whose stubs are pages
  endif()
  add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/site/index.html
    COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 data/guide/site/build.py
      $<TARGET_FILE:bernal_command> . ${PROJECT_BINARY_DIR}/site
    DEPENDS bernal_command ${module} ${pages} README.md CONTRIBUTING.md CHANGELOG.md src/README.md
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM COMMENT "Making the site")
  add_custom_target(bernal_site ALL DEPENDS ${PROJECT_BINARY_DIR}/site/index.html)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/site DESTINATION ${doc}/bernal COMPONENT command OPTIONAL)
endif()

find_program(BERNAL_SHLIBDEPS dpkg-shlibdeps)
if(NOT BERNAL_SHLIBDEPS)
  return()  # this is no Debian
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each has one of its own, in the first line of its description
set(CPACK_PACKAGE_VENDOR bernal)
set(CPACK_PACKAGE_CONTACT "bernal maintainers <maintainers@bernal.invalid>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip)  # xz saves a third of 12 MB and takes five times as long
# Each Debian has packages of its own, and an upgrade of the system is one of bernal: 1~deb12 comes before 1~deb13.
cmake_host_system_information(RESULT system QUERY DISTRIB_ID)
cmake_host_system_information(RESULT system_version QUERY DISTRIB_VERSION_ID)
cmake_host_system_information(RESULT codename QUERY DISTRIB_VERSION_CODENAME)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
if(system_version)
  string(REPLACE debian deb system "${system}")
  set(CPACK_DEBIAN_PACKAGE_RELEASE 1~${system}${system_version})
endif()
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/debian/dependencies.cmake)
set(CPACK_BERNAL_PROGRAM ${PROJECT_BINARY_DIR}/bernal)
set(CPACK_BERNAL_MODULE)
if(bernal_with_opencascade)
  set(CPACK_BERNAL_MODULE ${PROJECT_BINARY_DIR}/src/${CMAKE_SHARED_MODULE_PREFIX}bernal_opencascade${CMAKE_SHARED_MODULE_SUFFIX})
endif()
set(version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})

# A package of the components given, and of the copyright and the changelogs that policy wants of each.
set(policy ${PROJECT_BINARY_DIR}/policy)
set(CPACK_COMPONENTS_ALL)
macro(bernal_package name section description)
  string(MAKE_C_IDENTIFIER ${name} group)
  string(TOUPPER ${group} group)
  install(CODE "
    set(version ${version})
    set(codename ${codename})
    include(${PROJECT_SOURCE_DIR}/cmake/debian/write_changelogs.cmake)
    write_changelogs(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${policy})" COMPONENT ${group}_POLICY EXCLUDE_FROM_ALL)
  install(FILES ${policy}/changelog.gz ${policy}/changelog.Debian.gz ${PROJECT_SOURCE_DIR}/cmake/debian/copyright
    DESTINATION ${doc}/${name} COMPONENT ${group}_POLICY EXCLUDE_FROM_ALL)
  foreach(component ${ARGN} ${group}_POLICY)
    list(APPEND CPACK_COMPONENTS_ALL ${component})
    string(TOUPPER ${component} upper)
    set(CPACK_COMPONENT_${upper}_GROUP ${group})
  endforeach()
  set(CPACK_DEBIAN_${group}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${group}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${group}_PACKAGE_SUGGESTS tetgen)  # which meshes are filled by
  set(CPACK_DEBIAN_${group}_DESCRIPTION "${description}")
endmacro()

# What the command and its module link is found out in debian/dependencies.cmake.
bernal_package(bernal science
"packs spheres into CAD parts and proves that nothing overlaps
bernal fills a CAD part (STL, OBJ, PLY, 3MF, glTF, STEP, …), a simple shape or
a periodic box with as many spheres of given sizes as fit, or as many as are
asked for. Then it reads its own file back and decides for every two spheres
that are near each other, and for every sphere near the wall, whether they
overlap: in exact arithmetic wherever rounding could matter.
.
It measures packings, predicts how densely sizes pack, and hands packings over
to LAMMPS, LIGGGHTS, YADE, OpenMC, Gmsh, POV-Ray and others.
.
STEP, IGES and BREP are read and written by the recommended libraries of
Open CASCADE. The suggested TetGen makes the tetrahedra of bernal mesh."
  command)

set(depends)
foreach(component IN LISTS bernal_components)
  list(APPEND depends ${bernal_${component}_debian_packages})
endforeach()
list(REMOVE_DUPLICATES depends)
list(SORT depends)
list(JOIN depends ", " CPACK_DEBIAN_LIBBERNAL_DEV_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_LIBBERNAL_DEV_PACKAGE_RECOMMENDS "bernal (= ${version})")  # which has the module of Open CASCADE
bernal_package(libbernal-dev libdevel
"packs spheres and proves that nothing overlaps (C++ library)
bernal fills CAD parts, simple shapes and periodic boxes with spheres of given
sizes, and certifies packings in exact arithmetic.
.
This package has the static libraries, the C++20 headers and what
find_package(bernal) of CMake needs. Programs that read STEP, IGES or BREP
need the package bernal where they run."
  development)

get_cmake_property(components COMPONENTS)
if(python IN_LIST components)
  get_property(bernal_python GLOBAL PROPERTY bernal_python)
  string(REGEX MATCH "[0-9]+$" minor ${bernal_python})
  math(EXPR minor "${minor} + 1")
  string(REGEX REPLACE "[0-9]+$" ${minor} bernal_next_python ${bernal_python})
  set(CPACK_DEBIAN_PYTHON3_BERNAL_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON3_BERNAL_PACKAGE_DEPENDS "python3 (>= ${bernal_python}), python3 (<< ${bernal_next_python}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON3_BERNAL_PACKAGE_RECOMMENDS "bernal (= ${version})")
  set(CPACK_DEBIAN_PYTHON3_BERNAL_PACKAGE_CONTROL_EXTRA
    ${CMAKE_CURRENT_LIST_DIR}/debian/python/postinst ${CMAKE_CURRENT_LIST_DIR}/debian/python/prerm)
  bernal_package(python3-bernal python
"packs spheres and proves that nothing overlaps (Python module)
bernal fills CAD parts, simple shapes and periodic boxes with spheres of given
sizes, and certifies packings in exact arithmetic.
.
This package has the module for Python: scenes as classes, spheres as arrays of
NumPy, progress and pictures in notebooks. The package bernal has what reads
STEP, IGES and BREP."
    python)
endif()

include(CPack)
