# What differs between kinds of packages: whether shared libraries are brought along. CPack reads it once for each kind.
if(CPACK_GENERATOR STREQUAL DEB)
  list(REMOVE_ITEM CPACK_COMPONENTS_ALL libraries)
elseif(CPACK_GENERATOR STREQUAL TGZ AND CPACK_INSTALL_CMAKE_PROJECTS)
  list(GET CPACK_INSTALL_CMAKE_PROJECTS 0 build)
  list(APPEND CPACK_INSTALL_CMAKE_PROJECTS "${build}" Rouleau libraries /)
endif()
