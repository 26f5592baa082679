# find_package(counterpart_protocol) gives counterpart::counterpart_protocol.
include(CMakeFindDependencyMacro)
find_dependency(nlohmann_json 3.11)
find_dependency(OpenSSL 3)
find_dependency(Threads)
find_dependency(PkgConfig)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
include("${CMAKE_CURRENT_LIST_DIR}/counterpart_protocol-targets.cmake")
