# Two uses of one file: included, it gives limn_embed_shaders(TARGET); run with -P, it writes the source that holds the shaders.
if(CMAKE_SCRIPT_MODE_FILE)
  set(text "// Written by cmake/LimnShaders.cmake from the shaders folder.\n#include \"limn/gl/embedded_shaders.h\"\n\nnamespace limn::gl {\nnamespace {\n\nconstexpr EmbeddedShader kShaders[] = {\n")
  file(GLOB shaders ${FOLDER}/*.glsl)
  list(SORT shaders)
  foreach(shader IN LISTS shaders)
    get_filename_component(name ${shader} NAME)
    file(READ ${shader} content)
    string(APPEND text "    {\"${name}\", R\"limn_glsl(${content})limn_glsl\"},\n")
  endforeach()
  string(APPEND text "};\n\n}  // namespace\n\nstd::span<const EmbeddedShader> embedded_shaders() { return kShaders; }\n\n}  // namespace limn::gl\n")
  file(WRITE ${OUTPUT} "${text}")
  return()
endif()

set(LIMN_SHADERS_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

# limn_embed_shaders(TARGET): TARGET carries every shaders/*.glsl as text; editing one rebuilds it.
function(limn_embed_shaders target)
  set(folder ${PROJECT_SOURCE_DIR}/shaders)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_shaders.cpp)
  file(GLOB shaders CONFIGURE_DEPENDS ${folder}/*.glsl)
  add_custom_command(OUTPUT ${output} COMMAND ${CMAKE_COMMAND} -DFOLDER=${folder} -DOUTPUT=${output} -P ${LIMN_SHADERS_SCRIPT}
                     DEPENDS ${shaders} ${LIMN_SHADERS_SCRIPT} COMMENT "Embedding shaders" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
