# Writes to OUTPUT what makes a test of CTest, PREFIX.Suite, of each suite that PROGRAM has. Of suites, for to begin takes a program
# that links the CAD kernel a tenth of a second.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" lines "${listed}")
set(tests "")
foreach(line IN LISTS lines)
  if(line MATCHES "^([^ ]+)\\.( +#.*)?$")
    set(name "${PREFIX}.${CMAKE_MATCH_1}")
    string(APPEND tests "add_test([=[${name}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${CMAKE_MATCH_1}.*]=])\n"
                        "set_tests_properties([=[${name}]=] PROPERTIES WORKING_DIRECTORY [=[${FOLDER}]=])\n")
  endif()
endforeach()
file(WRITE ${OUTPUT} "${tests}")
