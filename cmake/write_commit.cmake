# cmake -D SOURCE=. -D TO=commit.cpp -P write_commit.cmake: what bernal::commit says, in a file that is written only where
# it becomes another one. Asked is the git that the source stands in, whose folder it must be itself; of a source archive
# it is the file cmake/commit, into which `git archive` writes the commit.
set(commit unknown)
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  # Who builds runs the source's own scripts anyway, so it does not matter to whom it belongs.
  set(git ${GIT} --no-optional-locks -c safe.directory=* -C ${SOURCE})
  execute_process(COMMAND ${git} rev-parse --verify --quiet HEAD
    OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  execute_process(COMMAND ${git} status --porcelain --untracked-files=no
    OUTPUT_VARIABLE changes RESULT_VARIABLE problem ERROR_QUIET)
elseif(EXISTS ${SOURCE}/cmake/commit)
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
