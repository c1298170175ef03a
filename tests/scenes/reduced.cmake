# How each scene of prm/ is run by the tests: two steps, which take all its sections
# through start, steps and end in less than a second. The table has what else a scene
# needs, "|" between overrides: one that takes longer gets a coarser grid.
set(reduced_overrides "Time/Largest number of steps=2")
set(reduced_contact.hertz_cylinder "Grid/Adaptation/Highest level=3")
set(reduced_contact.hertz_sphere "Grid/Adaptation/Highest level=3")
set(reduced_contact.hertz_two_cylinders "Grid/Adaptation/Highest level=3")
set(reduced_upsetting_quarter "Grid/Adaptation/Highest level=0")

# Adds the test of a scene, which is given by its file in prm/. None of its entries may do
# nothing.
function(add_reduced_run scene)
  string(REGEX REPLACE "\\.prm$" "" name ${scene})
  string(REPLACE "/" "." name ${name})
  set(overrides ${reduced_overrides})
  if(DEFINED reduced_${name})
    string(APPEND overrides "|${reduced_${name}}")
  endif()
  string(REPLACE "|" "|--set|" overrides "${overrides}")
  add_program_test(reduced.${name} 0 "bytes per point: [0-9]+.*everything else +[0-9.]+ s"
    "${scene}|--set|${overrides}" "does nothing")
endfunction()

# A table that names no scene has outlived it.
get_directory_property(names VARIABLES)
list(FILTER names INCLUDE REGEX "^reduced_")
list(REMOVE_ITEM names reduced_overrides)
foreach(name ${names})
  string(REGEX REPLACE "^reduced_" "" scene ${name})
  string(REPLACE "." "/" scene ${scene})
  if(NOT EXISTS ${PROJECT_SOURCE_DIR}/prm/${scene}.prm)
    message(FATAL_ERROR "tests/scenes/reduced.cmake has ${name}, but there is no prm/${scene}.prm")
  endif()
endforeach()
