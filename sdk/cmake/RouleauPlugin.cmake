# rouleau_add_plugin(NAME): builds lib<NAME>.so from NAME.cpp in this folder and puts the folder's manifests beside it:
# NAME.json, or one for each model where the library holds several.
# The wide-vector variants of the hot loops are made by the SDK's headers; no special flags are needed.
function(rouleau_add_plugin name)
  add_library(${name} MODULE ${CMAKE_CURRENT_SOURCE_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE Rouleau::SDK)
  set_target_properties(${name} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_compile_options(${name} PRIVATE -fno-math-errno -fno-trapping-math -Wno-psabi)
  file(GLOB manifests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.json)
  add_custom_command(TARGET ${name} POST_BUILD COMMAND ${CMAKE_COMMAND} -E copy_if_different
    ${manifests} $<TARGET_FILE_DIR:${name}>)
  set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS ${manifests})
endfunction()
