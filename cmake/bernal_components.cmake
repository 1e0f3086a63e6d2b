# The libraries that can be taken alone, each after those that it stands on, and what each needs from others: as
# find_package() calls it, and the Debian packages of what is linked or included. Read by the build, by the packages
# and, installed, by find_package(bernal). CONTRIBUTING.md says why each package is here; those that the build needs
# besides are listed in cmake/debian-packages.txt.
set(bernal_components core predict verify cad bernal figures)

set(bernal_core_packages "Eigen3 3.4 NO_MODULE" "Boost 1.74" "TBB" "fmt 9")
set(bernal_core_debian_packages libeigen3-dev libboost-dev libtbb-dev libfmt-dev)
set(bernal_predict_stands_on core)
set(bernal_predict_packages "NLopt 2.7")
set(bernal_predict_debian_packages libnlopt-dev)
set(bernal_verify_stands_on core)
set(bernal_cad_stands_on core)
set(bernal_cad_packages "CGAL 5.5" "assimp 5.2" "nlohmann_json 3.11")
set(bernal_cad_debian_packages libcgal-dev libassimp-dev libmd-dev libminizip-dev nlohmann-json3-dev)
set(bernal_bernal_stands_on core predict verify cad)
set(bernal_bernal_packages "tomlplusplus 3.3")
set(bernal_bernal_debian_packages libtomlplusplus-dev libminizip-dev)
set(bernal_figures_stands_on bernal)

# The components given and all that they stand on, in the order above.
function(bernal_with_foundations result)
  set(wanted ${ARGN})
  set(downwards ${bernal_components})
  list(REVERSE downwards)
  foreach(component IN LISTS downwards)
    if(component IN_LIST wanted)
      list(APPEND wanted ${bernal_${component}_stands_on})
    endif()
  endforeach()
  set(all ${bernal_components})
  foreach(component IN LISTS bernal_components)
    if(NOT component IN_LIST wanted)
      list(REMOVE_ITEM all ${component})
    endif()
  endforeach()
  set(${result} ${all} PARENT_SCOPE)
endfunction()
