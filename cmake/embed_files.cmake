# cmake -D FOLDER=src/formats/files -D HEADER=formats/templates.hpp -D TO=templates.cpp -P embed_files.cmake: every file
# of a folder and of folders below it as a string of C++ that the header declares, named after its path: gmsh.py is
# gmsh_py, snappy/Allmesh is snappy_Allmesh.
function(append_string to name text)
  if(text MATCHES "\\)embedded\"")
    message(FATAL_ERROR "${name} has what ends a string of C++: )embedded\"")
  endif()
  set(${to} "${${to}}const std::string_view ${name} = R\"embedded(${text})embedded\";\n" PARENT_SCOPE)
endfunction()

function(write_strings to header code)
  file(WRITE ${to} "#include \"${header}\"\n\nnamespace bernal {\n\n${code}\n}  // namespace bernal\n")
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  file(GLOB_RECURSE files RELATIVE ${FOLDER} ${FOLDER}/*)
  foreach(file IN LISTS files)
    file(READ ${FOLDER}/${file} text)
    string(REGEX REPLACE "[^A-Za-z0-9]" "_" name "${file}")
    append_string(code ${name} "${text}")
  endforeach()
  write_strings(${TO} ${HEADER} "${code}")
endif()
