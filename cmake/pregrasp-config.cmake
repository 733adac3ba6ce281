# find_package(pregrasp): the target pregrasp::pregrasp, and one for each folder (pregrasp::pregrasp_hand, ..).
include(CMakeFindDependencyMacro)
foreach(package
    Threads Eigen3 fmt nlohmann_json OpenSSL ZLIB assimp fcl Qhull Simbody NLopt urdfdom console_bridge PNG JPEG Freetype PkgConfig)
  find_dependency(${package})
endforeach()
pkg_check_modules(LUA REQUIRED QUIET IMPORTED_TARGET lua5.4-c++)
pkg_check_modules(EDIT REQUIRED QUIET IMPORTED_TARGET libedit)
pkg_check_modules(HTTPLIB REQUIRED QUIET IMPORTED_TARGET cpp-httplib)
include(${CMAKE_CURRENT_LIST_DIR}/pregrasp-targets.cmake)
