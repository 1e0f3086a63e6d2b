# Installs the build in BUILD below PREFIX and builds and runs the stranger's project against that.
function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} failed (${result}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(stranger ${PREFIX}/stranger)
file(REMOVE_RECURSE ${PREFIX})
run("install" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX})
run("configure" ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/stranger -B ${stranger} -G ${GENERATOR}
  -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_PREFIX_PATH=${PREFIX} -D CMAKE_BUILD_TYPE=Debug)
run("build" ${CMAKE_COMMAND} --build ${stranger})
run("pack_a_box" ${stranger}/pack_a_box ${stranger}/packing)
run("the installed command" ${PREFIX}/bin/bernal verify ${stranger}/packing)
run("only_predict" ${stranger}/only_predict)

# Who links bernal::predict gets neither the CAD libraries nor exact arithmetic.
run("ldd" ldd ${stranger}/only_predict)
foreach(library assimp CGAL mpfr)
  if(output MATCHES "${library}")
    message(FATAL_ERROR "a program that links only bernal::predict needs ${library}:\n${output}")
  endif()
endforeach()
