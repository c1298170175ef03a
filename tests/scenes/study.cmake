cmake_minimum_required(VERSION 3.25)

# Runs the STUDY of a stretched block with PROGRAM, interrupts it by taking a
# summary away, and runs it again.

function(run expression)
  execute_process(COMMAND ${PROGRAM} ${STUDY} --study --output ${OUTPUT} ${ARGN}
    RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT code EQUAL 0 OR NOT err STREQUAL "")
    message(FATAL_ERROR "exit code ${code}\n${out}${err}")
  endif()
  if(NOT out MATCHES "${expression}")
    message(FATAL_ERROR "no match of ${expression} in\n${out}")
  endif()
endfunction()

function(expect_rows)
  file(STRINGS ${OUTPUT}/study.csv rows)
  list(LENGTH rows n)
  if(NOT n EQUAL 7)
    message(FATAL_ERROR "${n} lines, expected 7:\n${rows}")
  endif()
  foreach(expression
      "^grid,step,grid_size,status,exit_code,wall_seconds,steps,.*,pull$"
      "^coarse,one,0.25,done,0,[0-9.e-]+,1,64,.*,-0.10[0-9]+$"
      "^coarse,two,0.25,done,0,[0-9.e-]+,2,64,.*,-0.10[0-9]+$"
      "^coarse,fails,0.25,.*the computation cannot go on: .*did not converge.*,2,.*,$"
      "^fine,one,0.125,done,0,[0-9.e-]+,1,256,.*,-0.10[0-9]+$"
      "^fine,two,0.125,done,0,[0-9.e-]+,2,256,.*,-0.10[0-9]+$"
      "^fine,fails,0.125,.*,2,.*,$")
    list(POP_FRONT rows row)
    if(NOT row MATCHES "${expression}")
      message(FATAL_ERROR "no match of ${expression} in\n${row}")
    endif()
  endforeach()
endfunction()

file(REMOVE_RECURSE ${OUTPUT})
run("fine_fails: ranks 1 . Grid/Cells=12, 8.*6 runs" --check)
if(EXISTS ${OUTPUT})
  message(FATAL_ERROR "--check has written")
endif()
run("5/6 fine_two: done.*step two.*along cell size")
expect_rows()
foreach(file study.json study.txt best.csv coarse_one/log.txt)
  if(NOT EXISTS ${OUTPUT}/${file})
    message(FATAL_ERROR "no ${file}")
  endif()
endforeach()

file(REMOVE ${OUTPUT}/coarse_two/summary.json)
run("coarse_one: kept, done.*coarse_two: done.*fine_two: kept, done")
expect_rows()

# Other parameters, other runs.
run("coarse_one: done.*fine_two: done" --set "Materials/rubber/Poisson's ratio=0.2")
run("coarse_one: kept, done" --set "Materials/rubber/Poisson's ratio=0.2")
