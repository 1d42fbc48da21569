# Fails if an object of a processor level (cmake/DuctileLevels.cmake) shows anything but its entry,
# or would run something before main(): a program on a lesser processor would then run that too.
#   cmake -D NM=... -D OBJDUMP=... -D ENTRY=... -P check_levels.cmake OBJECT...
cmake_minimum_required(VERSION 3.25)
math(EXPR last "${CMAKE_ARGC} - 1")
set(objects 0)
foreach(i RANGE ${last})
  if(NOT CMAKE_ARGV${i} MATCHES "\\.o$")
    continue()
  endif()
  set(object ${CMAKE_ARGV${i}})
  execute_process(COMMAND ${NM} --defined-only --extern-only ${object}
    OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" symbols "${symbols}")
  list(LENGTH symbols count)
  if(NOT count EQUAL 1 OR NOT symbols MATCHES "${ENTRY}")
    message(FATAL_ERROR "${object}: expected one symbol with ${ENTRY}, found:\n${symbols}")
  endif()
  execute_process(COMMAND ${OBJDUMP} --section-headers ${object}
    OUTPUT_VARIABLE sections COMMAND_ERROR_IS_FATAL ANY)
  if(sections MATCHES "\\.(init_array|ctors|preinit_array)")
    message(FATAL_ERROR "${object}: would run code before main(), on any processor")
  endif()
  math(EXPR objects "${objects} + 1")
endforeach()
if(objects EQUAL 0)
  message(FATAL_ERROR "no object was given")
endif()
message(STATUS "${objects} objects show nothing but ${ENTRY}")
