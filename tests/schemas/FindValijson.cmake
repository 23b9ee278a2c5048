# Finds valijson's headers; defines Valijson::Valijson. scripts/install-dependencies unpacks them from Debian's package
# into build/dependencies, because installing that package whole would bring in Qt and Poco for adapters unused here.
find_path(Valijson_INCLUDE_DIR valijson/validator.hpp
  HINTS "${PROJECT_SOURCE_DIR}/build/dependencies/usr/include")
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Valijson REQUIRED_VARS Valijson_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "run scripts/install-dependencies (Debian: libvalijson-dev)")
if(Valijson_FOUND AND NOT TARGET Valijson::Valijson)
  add_library(Valijson::Valijson INTERFACE IMPORTED)
  target_include_directories(Valijson::Valijson SYSTEM INTERFACE "${Valijson_INCLUDE_DIR}")
endif()
