# A program of this folder with LLVM's OpenMP runtime, though the project is built by another
# compiler: Clang compiles the one file that has OpenMP directives. Sets DUCTILE_LLVM_OPENMP where
# there is a Clang that can. With Clang as the project's compiler openmp_bench is that already.
set(DUCTILE_LLVM_OPENMP OFF)
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  return()
endif()
find_program(DUCTILE_LLVM_COMPILER clang++ DOC "Clang, to measure LLVM's OpenMP runtime")
if(DUCTILE_LLVM_COMPILER)
  file(REAL_PATH ${DUCTILE_LLVM_COMPILER} compiler)
  cmake_path(GET compiler PARENT_PATH folder)
  find_library(DUCTILE_LIBOMP omp HINTS ${folder}/../lib DOC "LLVM's OpenMP runtime")
endif()
if(DUCTILE_LLVM_COMPILER AND DUCTILE_LIBOMP)
  set(DUCTILE_LLVM_OPENMP ON)
endif()

function(llvm_openmp_benchmark name source)
  set(object ${CMAKE_CURRENT_BINARY_DIR}/${name}.o)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  separate_arguments(flags UNIX_COMMAND "${CMAKE_CXX_FLAGS_${build_type}}")
  set(include "$<TARGET_PROPERTY:runtime_bench_support,INTERFACE_INCLUDE_DIRECTORIES>")
  add_custom_command(OUTPUT ${object}
    COMMAND ${DUCTILE_LLVM_COMPILER} -std=c++20 ${flags} -fopenmp "-I$<JOIN:${include},;-I>"
      -c ${CMAKE_CURRENT_SOURCE_DIR}/${source} -o ${object} -MD -MF ${object}.d
    DEPENDS ${source} DEPFILE ${object}.d COMMAND_EXPAND_LISTS VERBATIM)
  add_executable(${name} ${object})
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_link_libraries(${name} PRIVATE runtime_bench_support ${DUCTILE_LIBOMP})
endfunction()
