# What `cmake --install` puts where, below any prefix: the program finds its data and its module from where it is itself. And the
# Debian packages that `cpack` makes of it: pregrasp, and pregrasp-dev for programs that link the library (find_package(pregrasp)).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The program.
set(data_folder ${CMAKE_INSTALL_DATADIR}/pregrasp)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
install(TARGETS pregrasp RUNTIME)
install(TARGETS pregrasp_mrpt LIBRARY DESTINATION lib/pregrasp)  # app/recording/mrpt_codec.cc
install(DIRECTORY assets lua scenes DESTINATION ${data_folder})
install(DIRECTORY tests/ladders DESTINATION ${data_folder}/tests)  # of eval --study ladder
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN "*.1" EXCLUDE)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(FILES docs/pregrasp.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
if(PREGRASP_TRAINER)
  install(TARGETS pregrasp-train RUNTIME COMPONENT trainer)
endif()

# The library: every folder's own, and one name for all of them.
add_library(pregrasp_all INTERFACE)
set_target_properties(pregrasp_all PROPERTIES EXPORT_NAME pregrasp)
target_link_libraries(pregrasp_all INTERFACE pregrasp_bindings pregrasp_studies)
target_compile_features(pregrasp_all INTERFACE cxx_std_20)
target_compile_options(pregrasp_all INTERFACE -UNDEBUG)  # as Debian's Simbody is built (CMakeLists.txt)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
get_property(libraries GLOBAL PROPERTY PREGRASP_LIBRARIES)
install(TARGETS ${libraries} pregrasp_all EXPORT pregrasp ARCHIVE)
install(DIRECTORY app render bindings DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pregrasp FILES_MATCHING PATTERN "*.h")
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pregrasp)
install(EXPORT pregrasp NAMESPACE pregrasp:: FILE pregrasp-targets.cmake DESTINATION ${config_folder})
write_basic_package_version_file(pregrasp-config-version.cmake COMPATIBILITY ExactVersion)
install(FILES cmake/pregrasp-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/pregrasp-config-version.cmake
        DESTINATION ${config_folder})

# The packages.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "The authors of pregrasp <pregrasp@localhost>")
set(CPACK_PACKAGE_VENDOR pregrasp)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME pregrasp)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS fonts-dejavu-core)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
  "plans how a hand pushes and tilts an object until it can grasp it\n The program, with its scenes, Lua files, networks and documents.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME pregrasp-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
file(STRINGS packages.txt needed REGEX "-dev$")  # the headers and libraries that it was built with
list(PREPEND needed "pregrasp (= ${PROJECT_VERSION})")
list(JOIN needed ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "pregrasp as a library\n Headers, static libraries and a CMake package.")
include(CPack)
