# Installs the libraries and the package that `find_package(Ductile COMPONENTS runtime meshadapt c)`
# finds. Each component has its own export, so that runtime installs without mesh adaptation.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(ductile_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Ductile)

# Installs one library with its headers and its export. `component` is runtime, meshadapt or c.
function(ductile_install_component target component)
  set_target_properties(${target} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    INSTALL_RPATH "$ORIGIN")
  install(TARGETS ${target} EXPORT Ductile_${component} COMPONENT ${component}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} NAMELINK_COMPONENT ${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT Ductile_${component} NAMESPACE Ductile:: FILE Ductile_${component}.cmake
    DESTINATION ${ductile_package_dir} COMPONENT ${component})
endfunction()

ductile_install_component(ductile_runtime runtime)
if(DUCTILE_BUILD_MESHADAPT)
  ductile_install_component(ductile_meshadapt meshadapt)
endif()
if(TARGET ductile_c)
  ductile_install_component(ductile_c c)
  # Relative to where the file is, so that it goes along when the prefix is moved.
  file(RELATIVE_PATH ductile_prefix_from_pc
    ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  string(REGEX REPLACE "/$" "" ductile_pc_prefix "\${pcfiledir}/${ductile_prefix_from_pc}")
  foreach(dir IN ITEMS libdir includedir)
    string(TOUPPER CMAKE_INSTALL_${dir} where)
    cmake_path(IS_ABSOLUTE ${where} is_absolute)
    set(ductile_pc_${dir} "${${where}}")
    if(NOT is_absolute)
      string(PREPEND ductile_pc_${dir} "\${prefix}/")
    endif()
  endforeach()
  configure_file(${PROJECT_SOURCE_DIR}/doors/c/ductile.pc.in ${PROJECT_BINARY_DIR}/ductile.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/ductile.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT c)
  install(FILES ${PROJECT_SOURCE_DIR}/doors/c/ductile.f90
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT c)
endif()
# PETSc loads it by its name; who links it needs PETSc's flags, not CMake's package.
if(TARGET ductile_petsc)
  set_target_properties(ductile_petsc PROPERTIES INSTALL_RPATH "$ORIGIN")
  install(TARGETS ductile_petsc COMPONENT petsc LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endif()
if(TARGET ductile_mpi)
  file(RELATIVE_PATH ductile_libraries_from_program
    ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(ductile_mpi PROPERTIES
    INSTALL_RPATH "$ORIGIN/${ductile_libraries_from_program}")
  install(TARGETS ductile_mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT petsc)
endif()
if(TARGET ductile)
  file(RELATIVE_PATH ductile_libraries_from_program
    ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(ductile PROPERTIES INSTALL_RPATH "$ORIGIN/${ductile_libraries_from_program}")
  install(TARGETS ductile RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(FILES ${PROJECT_SOURCE_DIR}/meshadapt/cli/help/ductile.bash RENAME ductile
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
  install(FILES ${PROJECT_SOURCE_DIR}/meshadapt/cli/help/_ductile
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
  install(FILES ${PROJECT_SOURCE_DIR}/meshadapt/cli/help/ductile.fish
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
  if(NOT CMAKE_CROSSCOMPILING)
    install(FILES ${PROJECT_BINARY_DIR}/meshadapt/cli/ductile.1
      DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  endif()
endif()

if(TARGET ductile_python_module)
  set(ductile_python_dir lib/python3/dist-packages/ductile)  # Debian's, for all versions of Python
  install(TARGETS ductile_python_module LIBRARY DESTINATION ${ductile_python_dir} COMPONENT python)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/doors/python/ductile/ DESTINATION ${ductile_python_dir} COMPONENT python
    FILES_MATCHING PATTERN *.py PATTERN *.pyi PATTERN py.typed PATTERN __pycache__ EXCLUDE)
endif()

get_target_property(ductile_library_type ductile_runtime TYPE)
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/DuctileConfig.cmake.in ${PROJECT_BINARY_DIR}/DuctileConfig.cmake
  INSTALL_DESTINATION ${ductile_package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/DuctileConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/DuctileConfig.cmake ${PROJECT_BINARY_DIR}/DuctileConfigVersion.cmake
  DESTINATION ${ductile_package_dir} COMPONENT runtime)
