# Reads the sources and fails, naming file and line, where one breaks the order of the layers:
#   1. runtime never includes meshadapt, nor mesh adaptation's sources the program's;
#   2. the runtime's other parts never include its colouring, so that nobody who runs rounds parses it;
#   3. OpenMP, atomics, locks, threads and signals appear in runtime only.
#   cmake -D SOURCE_DIR=... -P check_layers.cmake
cmake_minimum_required(VERSION 3.25)

set(failures "")

# Fails for every line that matches `pattern` in the sources under the folders, of which none may
# have a path that matches `except`.
function(forbid_except except pattern why)
  foreach(folder IN LISTS ARGN)
    file(GLOB_RECURSE sources ${SOURCE_DIR}/${folder}/*.cpp ${SOURCE_DIR}/${folder}/*.hpp
      ${SOURCE_DIR}/${folder}/*.h)
    if(except)
      list(FILTER sources EXCLUDE REGEX "${except}")
    endif()
    foreach(source IN LISTS sources)
      file(STRINGS ${source} lines REGEX "${pattern}")
      foreach(line IN LISTS lines)
        if(NOT line MATCHES "^ *//")
          file(RELATIVE_PATH shown ${SOURCE_DIR} ${source})
          string(APPEND failures "  ${shown}: ${line}\n    ${why}\n")
        endif()
      endforeach()
    endforeach()
  endforeach()
  set(failures "${failures}" PARENT_SCOPE)
endfunction()

function(forbid pattern why)
  forbid_except("" "${pattern}" "${why}" ${ARGN})
  set(failures "${failures}" PARENT_SCOPE)
endfunction()

set(below_program include/ductile runtime)
if(EXISTS ${SOURCE_DIR}/meshadapt)
  file(GLOB parts RELATIVE ${SOURCE_DIR} ${SOURCE_DIR}/meshadapt/*)
  list(REMOVE_ITEM parts meshadapt/cli meshadapt/CMakeLists.txt)
  list(APPEND below_program ${parts})
endif()

forbid("#include .*meshadapt" "runtime knows nothing of meshadapt" include/ductile/runtime runtime)
forbid_except("/runtime/colouring/" "#include .*/colouring/"
  "colouring stands on the other parts of runtime, not they on it" include/ductile/runtime runtime)
forbid("#include .*meshadapt" "runtime's tests build without meshadapt" tests/runtime)
forbid("#include .*cli/" "only the program includes the program" ${below_program} c petsc python)

set(above_runtime include/ductile/meshadapt meshadapt c petsc python docs/examples)
forbid("#pragma +omp|<omp\\.h>|omp_[a-z]+_" "OpenMP stays inside runtime" ${above_runtime})
forbid("<(atomic|mutex|shared_mutex|thread|condition_variable|future|semaphore|barrier|latch|stop_token)>"
  "atomics, locks and threads stay inside runtime" ${above_runtime})
forbid("std::(atomic|mutex|shared_mutex|thread|jthread|async|call_once)|__atomic_|__sync_|pthread_"
  "atomics, locks and threads stay inside runtime" ${above_runtime})
forbid("<(csignal|signal\\.h)>|sigaction|std::signal" "signals stay inside runtime" ${above_runtime})

if(failures)
  message(FATAL_ERROR "layers broken:\n${failures}")
endif()
message(STATUS "layers are in order")
