# Reads headers, and compiles templates, once for eight sources of a folder. `cmake --preset dev` compiles
# each source alone and finds what one is missing.
set(ductile_not_of_units "#pragma GCC diagnostic ignored \"-Wshadow\"
#ifndef __clang__
#pragma GCC diagnostic ignored \"-Wsubobject-linkage\"  // of what is private to a source
#endif")
# ductile_unite(TARGET...): unites the sources of those targets that exist.
function(ductile_unite)
  foreach(target IN LISTS ARGN)
    if(NOT TARGET ${target})
      continue()
    endif()
    get_target_property(sources ${target} SOURCES)
    get_target_property(root ${target} SOURCE_DIR)
    list(FILTER sources INCLUDE REGEX "\\.cpp$")
    foreach(source IN LISTS sources)
      cmake_path(GET source PARENT_PATH folder)
      string(MAKE_C_IDENTIFIER "${target}_${folder}" group)
      math(EXPR unit "0${size_of_${group}} / 8")
      math(EXPR size_of_${group} "0${size_of_${group}} + 1")
      cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${root})
      set_property(SOURCE ${source} TARGET_DIRECTORY ${target} PROPERTY UNITY_GROUP ${group}_${unit})
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP
      UNITY_BUILD_CODE_BEFORE_INCLUDE "${ductile_not_of_units}")
  endforeach()
endfunction()
ductile_unite(ductile_runtime ductile_meshadapt ductile_meshadapt_plain ductile_cli ductile_c
  ductile_distributed ductile_petsc_parts ductile_mpi ductile_python_module
  test_support runtime_tests meshadapt_tests io_tests cli_tests process_tests campaign_parts campaign_tests
  ductile_bench_cases ductile_adapt_bench bench_tests adapt_bench_tests
  irregular_bench_parts runtime_bench_support runtime_bench_tests
  ductile_paper compliance fingering synthetic)
# They have names in common with others.
set_source_files_properties(${PROJECT_SOURCE_DIR}/runtime/steal_by_signal.cpp
  TARGET_DIRECTORY ductile_runtime PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
if(TARGET ductile_cli)
  set(alone adapt_command.cpp convert_command.cpp info_command.cpp metric_command.cpp move_command.cpp
    transfer_command.cpp view_command.cpp picture/ellipses.cpp picture/scene_metric.cpp)
  list(TRANSFORM alone PREPEND ${PROJECT_SOURCE_DIR}/meshadapt/cli/)
  set_source_files_properties(${alone} TARGET_DIRECTORY ductile_cli PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endif()
