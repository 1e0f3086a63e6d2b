# What the package bernal depends on, asked of dpkg-shlibdeps for the files that go into it. The libraries of the module
# of Open CASCADE are recommended, not depended on: with OpenGL and LLVM they are twenty times the rest, and who has no
# STEP, IGES or BREP does without; installed without recommendations, the command says what to install.
set(folder ${CPACK_PACKAGE_DIRECTORY}/shlibdeps)
file(WRITE ${folder}/debian/control "Source: bernal\n\nPackage: bernal\nArchitecture: any\n")
set(module)
if(CPACK_BERNAL_MODULE)
  set(module -dRecommends ${CPACK_BERNAL_MODULE})
endif()
execute_process(COMMAND dpkg-shlibdeps -O -dDepends ${CPACK_BERNAL_PROGRAM} ${module}
  WORKING_DIRECTORY ${folder} OUTPUT_VARIABLE found ERROR_VARIABLE complaint RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "dpkg-shlibdeps: ${complaint}")
endif()
foreach(kind Depends Recommends)
  string(TOUPPER ${kind} upper)
  if(found MATCHES "shlibs:${kind}=([^\n]+)")
    set(CPACK_DEBIAN_BERNAL_PACKAGE_${upper} "${CMAKE_MATCH_1}")
  endif()
endforeach()
file(REMOVE_RECURSE ${folder})
