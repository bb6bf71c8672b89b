# limn_embed_patterns(TARGET): TARGET carries the refinement patterns that a program made of their sources writes at build time.
function(limn_embed_patterns target)
  set(folder ${PROJECT_SOURCE_DIR}/src/limn/refine/patterns)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/stored_patterns.cpp)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  list(REMOVE_ITEM sources ${folder}/stored.cpp)
  add_executable(limn_write_patterns ${folder}/generate/main.cpp ${sources} ${PROJECT_SOURCE_DIR}/src/limn/refine/grid.cpp)
  target_include_directories(limn_write_patterns PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(limn_write_patterns PRIVATE limn_build_flags)
  add_custom_command(OUTPUT ${output} COMMAND limn_write_patterns ${output} DEPENDS limn_write_patterns
                     COMMENT "Making refinement patterns" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
