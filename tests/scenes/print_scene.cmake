cmake_minimum_required(VERSION 3.25)

# What PROGRAM prints of a scene reads back and is the same scene.

file(REMOVE_RECURSE ${OUTPUT})
file(MAKE_DIRECTORY ${OUTPUT})
foreach(scene upsetting mesh/hole materials/one_cell studies/step_control_billet)
  foreach(from ${scene}.prm ${OUTPUT}/first.prm)
    if(EXISTS ${OUTPUT}/first.prm)
      set(to ${OUTPUT}/second.prm)
    else()
      set(to ${OUTPUT}/first.prm)
    endif()
    execute_process(COMMAND ${PROGRAM} --print-parameters ${from}
      RESULT_VARIABLE code OUTPUT_FILE ${to} ERROR_VARIABLE err)
    if(NOT code EQUAL 0 OR err MATCHES "impm_dealii")
      message(FATAL_ERROR "${from}: exit code ${code}\n${err}")
    endif()
  endforeach()
  file(READ ${OUTPUT}/first.prm first)
  file(READ ${OUTPUT}/second.prm second)
  if(NOT first STREQUAL second OR NOT first MATCHES "# Allowed: ")
    message(FATAL_ERROR "${scene} does not read back as it is")
  endif()
  file(REMOVE ${OUTPUT}/first.prm ${OUTPUT}/second.prm)
endforeach()

# All parameters as pages, and the same as JSON.
execute_process(COMMAND ${PROGRAM} --print-parameters=markdown -o ${OUTPUT}/pages
  RESULT_VARIABLE code)
foreach(page README geometry grid materials boundary_conditions study)
  if(NOT EXISTS ${OUTPUT}/pages/${page}.md)
    message(FATAL_ERROR "no page ${page}.md")
  endif()
endforeach()
