# cmake -D SOURCE=. -D TO=commit.cpp -P write_commit.cmake: what bernal::commit says, in a file that is written only where
# it becomes another one. Asked is the git that the source stands in, whose folder it must be itself; of a source archive
# it is the file cmake/commit, into which `git archive` writes the commit.
set(commit unknown)
set(said)
set(changes)
set(problem 0)
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  # Who builds runs the source's own scripts anyway, so it does not matter to whom it belongs. Hooks of another
  # repository name that one in the environment.
  set(git ${CMAKE_COMMAND} -E env --unset=GIT_DIR --unset=GIT_WORK_TREE --unset=GIT_INDEX_FILE
    ${GIT} --no-optional-locks -c safe.directory=* -C ${SOURCE})
  execute_process(COMMAND ${git} rev-parse --show-cdup --verify --quiet HEAD OUTPUT_VARIABLE said ERROR_QUIET)
  string(STRIP "${said}" said)  # "../" stands before it where the repository is that of a folder above
  execute_process(COMMAND ${git} status --porcelain -- CMakeLists.txt CMakePresets.json apps cmake data include src tests
    OUTPUT_VARIABLE changes RESULT_VARIABLE problem ERROR_QUIET)
endif()
if(NOT said MATCHES "^[0-9a-f]+$" AND EXISTS ${SOURCE}/cmake/commit)
  file(STRINGS ${SOURCE}/cmake/commit said LIMIT_COUNT 1)
  set(changes)
  set(problem 0)
endif()
if(said MATCHES "^[0-9a-f]+$")
  string(SUBSTRING ${said} 0 12 commit)
  if(changes OR NOT problem EQUAL 0)
    string(APPEND commit "+changes")
  endif()
endif()
file(CONFIGURE OUTPUT ${TO} NEWLINE_STYLE UNIX CONTENT [[
#include "bernal/version.hpp"

std::string_view bernal::commit() { return "@commit@"; }
]] @ONLY)
