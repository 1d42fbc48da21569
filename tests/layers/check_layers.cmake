# Reads the sources and fails, naming file and line, where one breaks the order of the layers:
#   1. runtime never includes meshadapt, nor mesh adaptation's sources the program's;
#   2. the runtime's other parts never include its colouring, so that nobody who runs rounds parses it;
#   3. OpenMP, atomics, locks, threads and signals appear in runtime only;
#   4. each floor of mesh adaptation includes lower ones only;
#   5. MPI appears in distributed and doors/petsc only, PETSc in doors/petsc.
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
forbid("#include .*cli/" "only the program includes the program" ${below_program}
  distributed doors)

set(without_mpi include/ductile runtime meshadapt doors/c doors/python)
forbid("<mpi\\.h>|MPI_[A-Z]|#include .*distributed/" "MPI stays inside distributed and doors/petsc" ${without_mpi})
forbid("[Pp][Ee][Tt][Ss][Cc]|DMPlex" "distributed knows nothing of PETSc" ${without_mpi} distributed)
# Without a folder, which the program's headers are included by.
forbid("#include \"[a-z_0-9]+\\.hpp\"" "distributed names the folders of what it includes" distributed)

set(above_runtime include/ductile/meshadapt meshadapt distributed doors docs/examples)
forbid("#pragma +omp|<omp\\.h>|omp_[a-z]+_" "OpenMP stays inside runtime" ${above_runtime})
forbid("<(atomic|mutex|shared_mutex|thread|condition_variable|future|semaphore|barrier|latch|stop_token)>"
  "atomics, locks and threads stay inside runtime" ${above_runtime})
forbid("std::(atomic|mutex|shared_mutex|thread|jthread|async|call_once)|__atomic_|__sync_|pthread_"
  "atomics, locks and threads stay inside runtime" ${above_runtime})
forbid("<(csignal|signal\\.h)>|sigaction|std::signal" "signals stay inside runtime" ${above_runtime})

# The floors of mesh adaptation, lowest first. Of rooms on one floor neither includes the other.
set(floors core mesh metric io,transfer,geometry checks,operators,levelset adapt move cli)
set(level 0)
foreach(floor IN LISTS floors)
  string(REPLACE "," ";" rooms ${floor})
  foreach(room IN LISTS rooms)
    set(level_of_${room} ${level})
    # A public header is in the room of its source; those that have none are listed below.
    file(GLOB sources RELATIVE ${SOURCE_DIR}/meshadapt/${room} ${SOURCE_DIR}/meshadapt/${room}/*.cpp)
    foreach(source IN LISTS sources)
      string(REPLACE .cpp "" name ${source})
      if(NOT room STREQUAL cli)
        set(room_of_${name} ${room})
      endif()
    endforeach()
  endforeach()
  math(EXPR level "${level} + 1")
endforeach()
foreach(place IN ITEMS core/simplex mesh/any_mesh mesh/mesh_arrays mesh/adapt_options io/files
    io/level_set_references)
  string(REPLACE "/" ";" parts ${place})
  list(GET parts 0 room)
  list(GET parts 1 name)
  set(room_of_${name} ${room})
endforeach()

# Fails for every include in a file of a room that is of the same floor's other rooms, or higher.
function(forbid_upwards file room)
  file(STRINGS ${file} lines REGEX "^#include \"")
  foreach(line IN LISTS lines)
    set(other "")
    if(line MATCHES "\"ductile/meshadapt/([a-z_]+)\\.hpp\"")
      set(other "${room_of_${CMAKE_MATCH_1}}")
    elseif(line MATCHES "\"([a-z]+)/[a-z_0-9]+\\.hpp\"")
      set(other ${CMAKE_MATCH_1})
    endif()
    if(DEFINED level_of_${other} AND NOT other STREQUAL room
       AND NOT level_of_${other} LESS level_of_${room})
      file(RELATIVE_PATH shown ${SOURCE_DIR} ${file})
      string(APPEND failures "  ${shown}: ${line}\n    ${room} knows nothing of ${other}\n")
    endif()
  endforeach()
  set(failures "${failures}" PARENT_SCOPE)
endfunction()

file(GLOB rooms RELATIVE ${SOURCE_DIR}/meshadapt ${SOURCE_DIR}/meshadapt/*)
list(REMOVE_ITEM rooms CMakeLists.txt)
foreach(room IN LISTS rooms)
  if(NOT DEFINED level_of_${room})
    string(APPEND failures "  meshadapt/${room} is on no floor; give it one in check_layers.cmake\n")
    continue()
  endif()
  file(GLOB_RECURSE files ${SOURCE_DIR}/meshadapt/${room}/*.?pp)
  foreach(file IN LISTS files)
    forbid_upwards(${file} ${room})
  endforeach()
endforeach()
file(GLOB headers ${SOURCE_DIR}/include/ductile/meshadapt/*.hpp)
foreach(header IN LISTS headers)
  get_filename_component(name ${header} NAME_WE)
  if(DEFINED room_of_${name})
    forbid_upwards(${header} ${room_of_${name}})
  else()
    string(APPEND failures "  ${name}.hpp is in no room; give it one in check_layers.cmake\n")
  endif()
endforeach()

if(failures)
  message(FATAL_ERROR "layers broken:\n${failures}")
endif()
message(STATUS "layers are in order")
