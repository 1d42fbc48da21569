# Compiles the hot part of a library once more for processors that can do more than all of those the
# library is built for. The library then holds both and chooses when it runs (see
# meshadapt/adapt/processor_level.hpp).
#
# What a compiler makes of an inline function or a template is shared by all that use it, so a
# program could end up with instructions that its processor does not have. Therefore the objects of
# a level are linked to one, of which only the entry is seen from outside. Link-time optimisation
# would look past that. Generators of several configurations get no levels.
include(CheckCXXSourceCompiles)

option(DUCTILE_PROCESSOR_LEVELS
  "Optimised builds for x86-64 also hold the kernels for processors with AVX2 and with AVX-512" ON)

set(ductile_flags_of_v3 -mpopcnt -mbmi -mbmi2 -mavx2)
set(ductile_flags_of_v4 ${ductile_flags_of_v3} -mavx512f -mavx512bw -mavx512cd -mavx512dq -mavx512vl)
check_cxx_source_compiles("#ifdef __AVX2__\n#error\n#endif\nint main() {}" DUCTILE_BUILT_BELOW_v3)
check_cxx_source_compiles("#ifdef __AVX512VL__\n#error\n#endif\nint main() {}" DUCTILE_BUILT_BELOW_v4)

# Sets `result` to the levels that are to be compiled.
function(ductile_levels result)
  set(${result} "" PARENT_SCOPE)
  if(NOT DUCTILE_PROCESSOR_LEVELS OR NOT CMAKE_BUILD_TYPE MATCHES "^(Release|RelWithDebInfo|None)$"
     OR NOT CMAKE_SYSTEM_NAME STREQUAL Linux OR NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$"
     OR NOT CMAKE_SIZEOF_VOID_P EQUAL 8 OR CMAKE_INTERPROCEDURAL_OPTIMIZATION OR CMAKE_CROSSCOMPILING
     OR CMAKE_CONFIGURATION_TYPES OR NOT CMAKE_OBJCOPY)
    return()
  endif()
  # LLVM's, which CMake takes for Clang, cannot do it.
  find_program(DUCTILE_OBJECT_LINKER NAMES ld.bfd ${CMAKE_LINKER})
  mark_as_advanced(DUCTILE_OBJECT_LINKER)
  execute_process(COMMAND ${DUCTILE_OBJECT_LINKER} --help OUTPUT_VARIABLE help ERROR_QUIET)
  if(NOT help MATCHES "force-group-allocation")
    message(STATUS "no processor levels: there is no linker that links objects to one")
    return()
  endif()
  set(levels "")
  foreach(level v3 v4)
    if(DUCTILE_BUILT_BELOW_${level})
      list(APPEND levels ${level})
    endif()
  endforeach()
  set(${result} ${levels} PARENT_SCOPE)
endfunction()

# ductile_add_levels(TARGET ENTRY SOURCE...): adds to the library TARGET what is compiled of the
# sources for each level. They see DUCTILE_LEVEL, its name; all sources of the library see
# DUCTILE_LEVEL_v3, DUCTILE_LEVEL_v4. ENTRY is a part of the names of what is seen from outside.
function(ductile_add_levels target entry)
  ductile_levels(levels)
  foreach(level IN LISTS levels)
    set(objects ${target}_${level})
    add_library(${objects} OBJECT ${ARGN})
    target_compile_definitions(${objects} PRIVATE DUCTILE_LEVEL=${level})
    target_include_directories(${objects} PRIVATE $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
    target_link_libraries(${objects} PRIVATE $<TARGET_PROPERTY:${target},LINK_LIBRARIES>)
    target_compile_options(${objects} PRIVATE $<TARGET_PROPERTY:${target},COMPILE_OPTIONS>
      ${ductile_flags_of_${level}} -fno-lto $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
    set(one ${CMAKE_CURRENT_BINARY_DIR}/${objects}.o)
    add_custom_command(OUTPUT ${one} DEPENDS ${objects} $<TARGET_OBJECTS:${objects}>
      COMMAND ${DUCTILE_OBJECT_LINKER} -r --force-group-allocation -o ${one} $<TARGET_OBJECTS:${objects}>
      COMMAND ${CMAKE_OBJCOPY} --wildcard "--keep-global-symbol=*${entry}*" ${one}
      COMMENT "Linking the objects of ${objects} to one" COMMAND_EXPAND_LISTS VERBATIM)
    target_sources(${target} PRIVATE ${one})
    target_compile_definitions(${target} PRIVATE DUCTILE_LEVEL_${level})
    set_property(TARGET ${target} APPEND PROPERTY DUCTILE_LEVEL_OBJECTS ${one})
  endforeach()
  if(levels)
    list(JOIN levels ", " names)
    message(STATUS "processor levels of ${target} beside as built: ${names}")
  endif()
endfunction()
