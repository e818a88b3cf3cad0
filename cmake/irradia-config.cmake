# irradia::irradia (shared) and irradia::static, found beside this file wherever the package lies: <prefix>/share/irradia/cmake.
get_filename_component(_irradia_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
find_path(IRRADIA_INCLUDE_DIR irradia.h PATHS "${_irradia_prefix}/include" NO_DEFAULT_PATH)
find_library(IRRADIA_LIBRARY NAMES irradia libirradia.so PATHS "${_irradia_prefix}" PATH_SUFFIXES lib lib64 "lib/${CMAKE_LIBRARY_ARCHITECTURE}" NO_DEFAULT_PATH)
find_library(IRRADIA_STATIC_LIBRARY NAMES libirradia.a PATHS "${_irradia_prefix}" PATH_SUFFIXES lib lib64 "lib/${CMAKE_LIBRARY_ARCHITECTURE}" NO_DEFAULT_PATH)
mark_as_advanced(IRRADIA_INCLUDE_DIR IRRADIA_LIBRARY IRRADIA_STATIC_LIBRARY)

if(NOT IRRADIA_INCLUDE_DIR OR NOT IRRADIA_LIBRARY)
  set(irradia_FOUND FALSE)
  set(irradia_NOT_FOUND_MESSAGE "irradia.h or libirradia is missing below ${_irradia_prefix}")
  return()
endif()

if(NOT TARGET irradia::irradia)
  add_library(irradia::irradia SHARED IMPORTED)
  set_target_properties(irradia::irradia PROPERTIES
    IMPORTED_LOCATION "${IRRADIA_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${IRRADIA_INCLUDE_DIR}")
endif()
if(IRRADIA_STATIC_LIBRARY AND NOT TARGET irradia::static)
  find_package(Threads REQUIRED)
  add_library(irradia::static STATIC IMPORTED)
  set_target_properties(irradia::static PROPERTIES
    IMPORTED_LOCATION "${IRRADIA_STATIC_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${IRRADIA_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "Threads::Threads;${CMAKE_DL_LIBS};m")
endif()
set(irradia_FOUND TRUE)
