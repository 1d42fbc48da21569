# Debian packages, made by `cpack -G DEB` in the build folder: ductile (the program), libductile-dev (all
# libraries with headers, for C++, C and Fortran) and, where they are built, python3-ductile and
# ductile-petsc. Configure with -D CMAKE_INSTALL_PREFIX=/usr, so that the libraries go where Debian has them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ductile)
set(CPACK_PACKAGE_VENDOR Ductile)
set(CPACK_PACKAGE_CONTACT "The authors of Ductile")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

# ductile_package(GROUP PACKAGE SECTION SUMMARY COMPONENT...)
function(ductile_package group package section summary)
  string(TOUPPER ${group} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION ${summary} PARENT_SCOPE)
  foreach(component IN LISTS ARGN)
    string(TOUPPER ${component} component)
    set(CPACK_COMPONENT_${component}_GROUP ${group} PARENT_SCOPE)
  endforeach()
endfunction()

ductile_package(program ductile science "Anisotropic mesh adaptation: the program" program)
ductile_package(libraries libductile-dev libdevel
  "Anisotropic mesh adaptation: libraries for C++, C and Fortran" runtime meshadapt c)
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_DEPENDS "libhwloc-dev, libboost-graph-dev, libpugixml-dev, zlib1g-dev")
ductile_package(python python3-ductile python "Anisotropic mesh adaptation: the Python package" python)
if(TARGET ductile_python_module)  # it is compiled for one version of Python
  get_directory_property(minor DIRECTORY ${PROJECT_SOURCE_DIR}/doors/python DEFINITION Python_VERSION_MINOR)
  math(EXPR next "${minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${minor}), python3 (<< 3.${next}), python3-numpy")
endif()
ductile_package(petsc ductile-petsc science
  "Anisotropic mesh adaptation: adaptor for PETSc and program for MPI" petsc)
set(CPACK_DEBIAN_PETSC_PACKAGE_RECOMMENDS ductile)
get_cmake_property(CPACK_COMPONENTS_ALL COMPONENTS)
include(CPack)
