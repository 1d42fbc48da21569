# ductile_add_headers(TARGET FOLDER): the public headers of a library, which are installed with it:
# all in include/FOLDER and below, so that none is left out that another one includes.
function(ductile_add_headers target folder)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/${folder}/*.hpp)
  target_sources(${target} PUBLIC FILE_SET HEADERS
    BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${headers})
endfunction()
