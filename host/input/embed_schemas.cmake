# Compiles the schema files into rouleau_input, so that the program and the installed schemas cannot differ, and installs
# the scene's beside the manifest's (which the SDK installs).
set(scene_schema "${PROJECT_SOURCE_DIR}/host/input/scene.schema.json")
set(lock_schema "${PROJECT_SOURCE_DIR}/host/input/lock.schema.json")
set(manifest_schema "${PROJECT_SOURCE_DIR}/sdk/schema/manifest.schema.json")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${scene_schema}" "${lock_schema}" "${manifest_schema}")

# A string literal may have 64 KiB at least in every compiler; adjacent raw strings keep each piece far below.
function(rouleau_string_literal file variable)
  file(READ "${file}" text)
  string(LENGTH "${text}" length)
  set(literal "")
  set(at 0)
  while(at LESS length)
    string(SUBSTRING "${text}" ${at} 8000 piece)
    string(APPEND literal "\n    R\"schema(${piece})schema\"")
    math(EXPR at "${at} + 8000")
  endwhile()
  set(${variable} "${literal}" PARENT_SCOPE)
endfunction()

rouleau_string_literal("${scene_schema}" SCENE_SCHEMA_LITERAL)
rouleau_string_literal("${lock_schema}" LOCK_SCHEMA_LITERAL)
rouleau_string_literal("${manifest_schema}" MANIFEST_SCHEMA_LITERAL)
configure_file("${CMAKE_CURRENT_LIST_DIR}/embedded_schemas.cpp.in" "${PROJECT_BINARY_DIR}/generated/embedded_schemas.cpp" @ONLY)
target_sources(rouleau_input PRIVATE "${PROJECT_BINARY_DIR}/generated/embedded_schemas.cpp")
install(FILES "${scene_schema}" "${lock_schema}" DESTINATION ${CMAKE_INSTALL_DATADIR}/rouleau/schema)
