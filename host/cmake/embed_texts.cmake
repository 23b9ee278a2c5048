# rouleau_embed_texts(TARGET NAMESPACE HEADER VARIABLE FILE ...) compiles text files into a library of the host, each as the
# `const std::string_view VARIABLE` of namespace rouleau::NAMESPACE that HEADER declares; pictures (.png) byte by byte. The program then needs no file beside
# it, and what it holds and what is installed cannot differ.
function(rouleau_embed_texts target namespace header)
  set(definitions "")
  while(ARGN)
    list(POP_FRONT ARGN variable file)
    if(file MATCHES "\\.png$")
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
      file(READ "${file}" bytes HEX)
      file(SIZE "${file}" size)
      string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${bytes}")
      string(APPEND definitions "\nconst std::string_view ${variable}{\"${bytes}\", ${size}};\n")
      continue()
    endif()
    rouleau_read_text(text "${file}")
    # Where a shipped scene has its schema is not where a scene made from it has it.
    string(REGEX REPLACE "\n *\"[$]schema\": \"[.][^\n]*" "" text "${text}")
    string(APPEND definitions "\nconst std::string_view ${variable} = R\"ROULEAU(${text})ROULEAU\";\n")
  endwhile()
  rouleau_embedded_source(${target} ${namespace} "${header}" "${definitions}")
endfunction()

# rouleau_embed_schemas(TARGET NAMESPACE FUNCTION FILE ...) does so with JSON, which `const nlohmann::json& FUNCTION()` of
# rouleau::NAMESPACE reads once; a header of the folder declares it. A schema that refers to matrix.schema.json gets its
# definitions.
function(rouleau_embed_schemas target namespace)
  rouleau_read_text(matrix "${CMAKE_CURRENT_SOURCE_DIR}/trial/matrix.schema.json")
  set(definitions "")
  while(ARGN)
    list(POP_FRONT ARGN function file)
    rouleau_read_text(text "${file}")
    if(text MATCHES "matrix.schema.json#/")
      string(REPLACE "matrix.schema.json#/" "#/" text "${text}")
      string(JSON own ERROR_VARIABLE none GET "${text}" definitions)
      if(none)
        string(JSON text SET "${text}" definitions "{}")
      endif()
      string(JSON count LENGTH "${matrix}" definitions)
      math(EXPR last "${count} - 1")
      foreach(index RANGE ${last})
        string(JSON name MEMBER "${matrix}" definitions ${index})
        string(JSON own ERROR_VARIABLE free GET "${text}" definitions ${name})
        if(NOT free)
          message(FATAL_ERROR "${file} and matrix.schema.json both define ${name}")
        endif()
        string(JSON definition GET "${matrix}" definitions ${name})
        string(JSON text SET "${text}" definitions ${name} "${definition}")
      endforeach()
    endif()
    string(APPEND definitions "\nconst nlohmann::json& ${function}();\nconst nlohmann::json& ${function}() {\n"
           "  static const auto schema = nlohmann::json::parse(R\"ROULEAU(${text})ROULEAU\");\n  return schema;\n}\n")
  endwhile()
  rouleau_embedded_source(${target} ${namespace} json/json.hpp "${definitions}")
endfunction()

function(rouleau_read_text result file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
  file(READ "${file}" text)
  if(text MATCHES "\\)ROULEAU\"")
    message(FATAL_ERROR "${file} holds the end mark of the raw string it is to be embedded in")
  endif()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

function(rouleau_embedded_source target namespace header definitions)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/embedded/${target}.cpp")
  file(CONFIGURE OUTPUT "${source}" @ONLY CONTENT [[
// Written by CMake (host/cmake/embed_texts.cmake).
#include "@header@"

namespace rouleau::@namespace@ {
@definitions@
}  // namespace rouleau::@namespace@
]])
  target_sources(${target} PRIVATE "${source}")
  # Of the texts' lengths the standard promises 64 KiB alone, and clang++ says so.
  set_source_files_properties("${source}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON COMPILE_OPTIONS -Wno-overlength-strings)
endfunction()

# rouleau_assemble_page(RESULT TEMPLATE) writes RESULT: TEMPLATE with every line "@include FILE@" replaced by that file,
# whose path counts from the template's folder. Comments of our scripts that have a line to themselves stay behind: every page would
# carry them.
function(rouleau_assemble_page result template)
  get_filename_component(folder "${template}" DIRECTORY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${template}")
  file(READ "${template}" page)
  string(REGEX MATCHALL "@include [^@\n]+@" includes "${page}")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE "@include ([^@]+)@" "\\1" piece "${include}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${folder}/${piece}")
    file(READ "${folder}/${piece}" text)
    if(piece MATCHES "^[^/]*\\.js$")
      string(REGEX REPLACE "\n *//[^\n]*" "" text "\n${text}")
    endif()
    string(REPLACE "${include}" "${text}" page "${page}")
  endforeach()
  file(WRITE "${result}" "${page}")
endfunction()

# rouleau_require_file(FILE SHA256 WORDS) stops with WORDS unless FILE is there with these bytes.
function(rouleau_require_file file sha256 words)
  set(found "missing")
  if(EXISTS "${file}")
    file(SHA256 "${file}" found)
  endif()
  if(NOT found STREQUAL sha256)
    message(FATAL_ERROR "${file}\n  has SHA-256 ${found}, wanted ${sha256}\n  ${words}")
  endif()
endfunction()
