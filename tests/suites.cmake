# After every build of TESTS: its suites become tests of CTest in the file TO, FOLDER/SUITE with LABEL and TIMEOUT. To
# start a process takes longer than most cases of a suite: so one runs up to thirty-two of them.
execute_process(COMMAND ${TESTS} --gtest_list_tests OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE " +#[^\n]*" "" lines "${lines}")  # values of parameters
string(REPLACE "\n" ";" lines "${lines}")
set(suites)
foreach(line IN LISTS lines)
  if(line MATCHES "^([A-Za-z0-9_/]+)[.]$")
    set(suite ${CMAKE_MATCH_1})
    list(APPEND suites ${suite})
    set(cases_of_${suite} 0)
  elseif(line MATCHES "^  ")
    math(EXPR cases_of_${suite} "${cases_of_${suite}} + 1")
  endif()
endforeach()

# All cases are skipped, and none has failed: nothing follows their list.
set(nothing_but_skipped "PASSED  . 0 tests[.]\n(.  SKIPPED [^\n]*\n)+$")

set(tests)
foreach(suite IN LISTS suites)
  math(EXPR parts "(${cases_of_${suite}} + 31) / 32")
  foreach(part RANGE 1 ${parts})
    set(name ${FOLDER}/${suite})
    if(parts GREATER 1)
      string(APPEND name /${part}_of_${parts})
    endif()
    math(EXPR index "${part} - 1")
    string(APPEND tests "add_test(${name} [[${TESTS}]] --gtest_filter=${suite}.*)\n"
      "set_tests_properties(${name} PROPERTIES LABELS ${LABEL} TIMEOUT ${TIMEOUT}\n"
      "  ENVIRONMENT [[GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${index}]]\n"
      "  SKIP_REGULAR_EXPRESSION [[${nothing_but_skipped}]])\n")
  endforeach()
endforeach()
file(WRITE ${TO} "${tests}")
