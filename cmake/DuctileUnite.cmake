# Headers are read, and templates compiled, once for eight sources of a library or of its tests. The sanitizers' builds
# are made so, and that of the Python package from the sources; others compile each source alone and see
# what is missing, shadowed or unused in it.
set(ductile_not_of_units "#pragma GCC diagnostic ignored \"-Wshadow\"
#ifndef __clang__
#pragma GCC diagnostic ignored \"-Wsubobject-linkage\"  // of what is private to a source
#endif")
# ductile_unite(TARGET...): of the targets that there are.
function(ductile_unite)
  foreach(target IN LISTS ARGN)
    if(TARGET ${target})
      set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8
        UNITY_BUILD_CODE_BEFORE_INCLUDE "${ductile_not_of_units}")
    endif()
  endforeach()
endfunction()
ductile_unite(ductile_runtime ductile_meshadapt ductile_meshadapt_v3 ductile_meshadapt_v4)
# It has names in common with others.
set_source_files_properties(${PROJECT_SOURCE_DIR}/runtime/steal_by_signal.cpp
  TARGET_DIRECTORY ductile_runtime PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
