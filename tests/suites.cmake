# After every build of TESTS: each of its suites becomes a test of CTest in the file TO, FOLDER/SUITE with LABEL and
# TIMEOUT. To start a process takes longer than most tests of a suite, so that one process runs all of them.
execute_process(COMMAND ${TESTS} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n[A-Za-z0-9_/]+[.]" suites "\n${listed}")
set(tests)
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "[\n.]" "" suite "${suite}")
  string(APPEND tests "add_test([[${FOLDER}/${suite}]] [[${TESTS}]] [[--gtest_filter=${suite}.*]])\n"
    "set_tests_properties([[${FOLDER}/${suite}]] PROPERTIES LABELS ${LABEL} TIMEOUT ${TIMEOUT}\n"
    "  SKIP_REGULAR_EXPRESSION [[PASSED  . 0 tests]])\n")
endforeach()
file(WRITE ${TO} "${tests}")
