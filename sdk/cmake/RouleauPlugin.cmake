# rouleau_add_plugin(NAME) builds lib<NAME>.so from NAME.cpp, or NAME.c, in this folder and puts the folder's manifests
# beside it: NAME.json, or one for each model where the library holds several.
#
# It sets what every plugin needs: C++17 or C11 at least, an optimised build if none was chosen, flags that let loops
# become vector code without changing results, and that the library exports rouleau_open_v1 and nothing else. The
# wide-vector variants of the hot loops are made by the SDK's headers; no further flags are needed.
set(ROULEAU_PLUGIN_VERSION_SCRIPT "${CMAKE_CURRENT_LIST_DIR}/rouleau-plugin.map")

# The manifests in the current folder, which may also hold files of CMake and of editors.
function(rouleau_manifests variable)
  file(GLOB manifests CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.json")
  list(FILTER manifests EXCLUDE REGEX "/(CMakePresets|CMakeUserPresets|compile_commands)\\.json$")
  set(${variable} "${manifests}" PARENT_SCOPE)
endfunction()

function(rouleau_add_plugin name)
  set(source "${CMAKE_CURRENT_SOURCE_DIR}/${name}.cpp")
  set(language cxx_std_17)
  set(libraries Rouleau::SDK)
  if(NOT EXISTS "${source}")
    set(source "${CMAKE_CURRENT_SOURCE_DIR}/${name}.c")
    set(language c_std_11)
    list(APPEND libraries m)
  endif()
  if(NOT EXISTS "${source}")
    message(FATAL_ERROR "rouleau_add_plugin(${name}): neither ${name}.cpp nor ${name}.c is in ${CMAKE_CURRENT_SOURCE_DIR}")
  endif()
  rouleau_manifests(manifests)
  if(NOT manifests)
    message(FATAL_ERROR "rouleau_add_plugin(${name}): no manifest, ${name}.json, is in ${CMAKE_CURRENT_SOURCE_DIR}")
  endif()
  get_property(several_configurations GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
  if(NOT CMAKE_BUILD_TYPE AND NOT several_configurations)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
  endif()

  add_library(${name} MODULE "${source}")
  target_link_libraries(${name} PRIVATE ${libraries})
  target_compile_features(${name} PRIVATE ${language})
  set_target_properties(${name} PROPERTIES C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON PREFIX lib SUFFIX .so)
  target_compile_options(${name} PRIVATE -fno-math-errno -fno-trapping-math $<$<COMPILE_LANGUAGE:CXX>:-Wno-psabi>)
  target_link_options(${name} PRIVATE "LINKER:--version-script=${ROULEAU_PLUGIN_VERSION_SCRIPT}")
  add_custom_command(TARGET ${name} POST_BUILD COMMAND ${CMAKE_COMMAND} -E copy_if_different
    ${manifests} $<TARGET_FILE_DIR:${name}> VERBATIM)
  set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS ${manifests} "${ROULEAU_PLUGIN_VERSION_SCRIPT}")
endfunction()

# rouleau_add_conformance_test(NAME) adds the test conform_NAME, which asks the program "rouleau" whether the plugin that
# rouleau_add_plugin(NAME) builds keeps the interface's rules and its own claims. Without the program no test is added.
function(rouleau_add_conformance_test name)
  if(TARGET rouleau)
    set(program $<TARGET_FILE:rouleau>)
  elseif(ROULEAU_PROGRAM)
    set(program "${ROULEAU_PROGRAM}")
  else()
    message(NOTICE "The test conform_${name} is left out: there is no program \"rouleau\" beside the SDK or in PATH; "
      "name one with -DROULEAU_PROGRAM=/folder/rouleau")
    return()
  endif()
  rouleau_manifests(manifests)
  list(TRANSFORM manifests REPLACE "^.*/" "$<TARGET_FILE_DIR:${name}>/")
  add_test(NAME conform_${name} COMMAND ${program} conform ${manifests})
endfunction()
