# Embeds techniques/ and shaders/ into the library, so that an installed SDK needs no data files.
# The tree is scanned: a new folder is found without being listed anywhere.
function(relievo_embed_sources target)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
       ${PROJECT_SOURCE_DIR}/techniques/*.toml ${PROJECT_SOURCE_DIR}/techniques/*.glsl
       ${PROJECT_SOURCE_DIR}/shaders/*.toml ${PROJECT_SOURCE_DIR}/shaders/*.glsl)
  list(SORT files)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated/embedded_sources.cpp)
  set(list_file ${CMAKE_CURRENT_BINARY_DIR}/generated/embedded_sources.txt)
  list(JOIN files "\n" list_text)
  file(CONFIGURE OUTPUT ${list_file} CONTENT "${list_text}\n" @ONLY)
  list(TRANSFORM files PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE absolute_files)
  add_custom_command(
    OUTPUT ${generated}
    COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DLIST=${list_file} -DOUTPUT=${generated}
            -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${absolute_files} ${list_file} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
    COMMENT "Embedding techniques and shaders" VERBATIM)
  target_sources(${target} PRIVATE ${generated})
endfunction()
