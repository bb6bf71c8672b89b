# What `cmake --install` lays down: libraries, public headers, a CMake package with components, and pkg-config files.
# Everything in it is found relative to itself, so that an installed tree may be moved.
include(CMakePackageConfigHelpers)

set(LIMN_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/limn)

# limn_install_headers(FOLDER…): the headers that src/limn/public_headers.txt lists in these folders.
function(limn_install_headers)
  set(list ${PROJECT_SOURCE_DIR}/src/limn/public_headers.txt)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list})
  foreach(folder IN LISTS ARGN)
    file(STRINGS ${list} headers REGEX "^${folder}/")
    foreach(header IN LISTS headers)
      get_filename_component(room ${header} DIRECTORY)
      install(FILES ${PROJECT_SOURCE_DIR}/src/limn/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/limn/${room})
    endforeach()
  endforeach()
endfunction()

# limn_install_module(NAME): the library limn_NAME, as the component NAME of the package.
function(limn_install_module name)
  install(TARGETS limn_${name} EXPORT limn_${name}_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT limn_${name}_targets FILE limn-${name}-targets.cmake NAMESPACE limn:: DESTINATION ${LIMN_CMAKE_DIR})
endfunction()

# limn_install_pkgconfig(NAME): NAME.pc from cmake/NAME.pc.in. The prefix is found from the place of the file itself.
function(limn_install_pkgconfig name)
  file(RELATIVE_PATH LIMN_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

# A static library's own needs are its users' needs: pkg-config has to name them, with --static or without.
set(LIMN_PC_CORE_LIBS "-lfmt -lstb")
if(LIMN_GLTF_COMPRESSION AND LIMN_DRACO_LIBRARY AND LIMN_DRACO_INCLUDE)
  string(APPEND LIMN_PC_CORE_LIBS " -ldraco")
endif()
if(LIMN_GLTF_COMPRESSION AND LIMN_MESHOPTIMIZER_LIBRARY AND LIMN_MESHOPTIMIZER_INCLUDE)
  string(APPEND LIMN_PC_CORE_LIBS " -lmeshoptimizer")
endif()
if(LIMN_TBB)
  string(APPEND LIMN_PC_CORE_LIBS " -ltbb")
endif()
if(LIMN_ASSIMP AND assimp_FOUND)
  set(LIMN_INSTALL_ASSIMP ON)
  string(APPEND LIMN_PC_CORE_LIBS " -lassimp")
else()
  set(LIMN_INSTALL_ASSIMP OFF)
endif()
if(LIMN_EMBREE AND embree_FOUND)
  set(LIMN_INSTALL_EMBREE ON)
  string(APPEND LIMN_PC_CORE_LIBS " -lembree3")
else()
  set(LIMN_INSTALL_EMBREE OFF)
endif()

limn_install_headers(${LIMN_CORE_FOLDERS})
limn_install_module(core)
limn_install_pkgconfig(limn-core)
set(LIMN_PC_MODULES limn-core)
if(LIMN_GL)
  limn_install_headers(${LIMN_GL_FOLDERS})
  limn_install_module(gl)
  limn_install_pkgconfig(limn-gl)
  set(LIMN_PC_MODULES limn-gl)
endif()
limn_install_pkgconfig(limn)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/limn-config.cmake.in ${PROJECT_BINARY_DIR}/limn-config.cmake
                              INSTALL_DESTINATION ${LIMN_CMAKE_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/limn-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/limn-config.cmake ${PROJECT_BINARY_DIR}/limn-config-version.cmake
        DESTINATION ${LIMN_CMAKE_DIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
