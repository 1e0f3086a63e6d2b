# cmake -D FOLDER=src/io/viewer -D TO=viewer_files.cpp -P embed_viewer.cmake: the style sheet and the program of the view
# as C++. The modules become one script, in the order below, in a scope of its own: their imports and the word export go,
# for all names differ. Shaders become the strings that shaders.js asks for. Lines that are comments are left out.
set(modules data colours camera shaders walls images renderer order pick labels panel controls view)

function(read_without_comments file to)
  file(READ ${file} text)
  if(text MATCHES "</script|<!--|\\)viewer\"|[^\n\t -~]")
    message(FATAL_ERROR "${file} has what may not stand in a page's script, or is not ASCII: ${CMAKE_MATCH_0}")
  endif()
  string(REGEX REPLACE "(^|\n)[ ]*//[^\n]*" "\\1" text "${text}")
  string(REGEX REPLACE "\n[ \n]*\n" "\n" text "${text}")
  set(${to} "${text}" PARENT_SCOPE)
endfunction()

set(script "(() => {\n\"use strict\";\nconst shaderTexts = {\n")
file(GLOB shaders ${FOLDER}/*.vert ${FOLDER}/*.frag)
foreach(shader IN LISTS shaders)
  cmake_path(GET shader FILENAME name)
  read_without_comments(${shader} text)
  if(text MATCHES "[`$\\\\]")
    message(FATAL_ERROR "${shader} has what ends a string of JavaScript: ${CMAKE_MATCH_0}")
  endif()
  string(APPEND script "\"${name}\": `${text}`,\n")
endforeach()
string(APPEND script "};\n")
foreach(module IN LISTS modules)
  read_without_comments(${FOLDER}/${module}.js text)
  string(REGEX REPLACE "(^|\n)import [^\n]*" "\\1" text "${text}")
  string(REGEX REPLACE "(^|\n)export " "\\1" text "${text}")
  string(APPEND script "${text}")
endforeach()
string(APPEND script "})();\n")
read_without_comments(${FOLDER}/view.css style)

file(WRITE ${TO}
  "#include \"io/viewer_files.hpp\"\n\nnamespace bernal {\n\n"
  "const std::string_view viewer_style = R\"viewer(${style})viewer\";\n"
  "const std::string_view viewer_script = R\"viewer(${script})viewer\";\n\n}  // namespace bernal\n")
