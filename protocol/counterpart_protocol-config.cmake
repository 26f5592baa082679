# find_package(counterpart_protocol) gives counterpart::counterpart_protocol;
# with COMPONENTS h264 counterpart::counterpart_h264, too, which takes libavcodec.
include(CMakeFindDependencyMacro)
find_dependency(nlohmann_json 3.11)
find_dependency(OpenSSL 3)
find_dependency(Threads)
find_dependency(PkgConfig)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
include("${CMAKE_CURRENT_LIST_DIR}/counterpart_protocol-targets.cmake")
if("h264" IN_LIST counterpart_protocol_FIND_COMPONENTS)
  pkg_check_modules(AVCODEC REQUIRED IMPORTED_TARGET libavcodec libswscale libavutil)
  include("${CMAKE_CURRENT_LIST_DIR}/counterpart_h264-targets.cmake")
  set(counterpart_protocol_h264_FOUND TRUE)
endif()
