cmake_minimum_required(VERSION 3.25)

# Runs PROGRAM with ARGUMENTS ("|" between them) and checks the exit CODE, what
# it says, and what it leaves behind.

file(REMOVE_RECURSE ${OUTPUT})
string(REPLACE ";" "\\;" ARGUMENTS "${ARGUMENTS}")
string(REPLACE "|" ";" ARGUMENTS "${ARGUMENTS}")
if(NOT "--output" IN_LIST ARGUMENTS)
  list(APPEND ARGUMENTS --output ${OUTPUT})
endif()
execute_process(COMMAND ${PROGRAM} ${ARGUMENTS}
  RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)

if(NOT code EQUAL CODE)
  message(FATAL_ERROR "exit code ${code}, expected ${CODE}\n${out}${err}")
endif()
if(NOT "${out}${err}" MATCHES "${EXPRESSION}")
  message(FATAL_ERROR "no match of ${EXPRESSION} in\n${out}${err}")
endif()
if(CODE GREATER 0)
  string(REGEX MATCHALL "\n" lines "${err}")
  list(LENGTH lines n)
  if(NOT n EQUAL 1 OR NOT err MATCHES "^impm_dealii: ")
    message(FATAL_ERROR "not one message:\n${err}")
  endif()
endif()
if(CODE EQUAL 1 AND EXISTS ${OUTPUT})
  message(FATAL_ERROR "bad input, but ${OUTPUT} has been written")
endif()
if(CODE EQUAL 2)
  foreach(file history.csv summary.json parameters.prm particles.pvd
      checkpoint/last_good)
    if(NOT EXISTS ${OUTPUT}/${file})
      message(FATAL_ERROR "the last good state lacks ${file}")
    endif()
  endforeach()
endif()
