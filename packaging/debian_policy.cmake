# What Debian asks of every package, beside the project's files: licence, changelogs, compressed manual pages.
if(NOT CPACK_GENERATOR STREQUAL DEB)
  return()
endif()
cmake_policy(VERSION 3.25)
get_filename_component(source "${CMAKE_CURRENT_LIST_DIR}" DIRECTORY)
set(version ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH, where it is set
file(GLOB groups LIST_DIRECTORIES true "${CPACK_TEMPORARY_DIRECTORY}/*")
foreach(group ${groups})
  get_filename_component(name "${group}" NAME)
  string(TOUPPER "${name}" name)
  set(share "${group}${CPACK_PACKAGING_INSTALL_PREFIX}/share")
  set(documentation "${share}/doc/${CPACK_DEBIAN_${name}_PACKAGE_NAME}")
  configure_file("${source}/LICENSE" "${documentation}/copyright" COPYONLY)
  configure_file("${source}/CHANGELOG.md" "${documentation}/changelog" COPYONLY)
  file(WRITE "${documentation}/changelog.Debian" "rouleau (${version}) unstable; urgency=medium

  * Version ${CPACK_PACKAGE_VERSION}: changelog.gz says what is new.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
  file(GLOB pages "${share}/man/man*/*.[1-8]")
  execute_process(COMMAND gzip --best --no-name --force "${documentation}/changelog"
    "${documentation}/changelog.Debian" ${pages} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
