# An overlay port, built from the tree that it lies in:
#   vcpkg install animeme[dam] --overlay-ports=tools/release/packaging/vcpkg
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES dam ANIMEME_BUILD_DAM)
# libanimeme is one shared object with names of its own; where libraries are archives, those of C++
# are all there is.
string(COMPARE EQUAL "${VCPKG_LIBRARY_LINKAGE}" "dynamic" shared)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS ${features}
  -DANIMEME_BUILD_TOOLS=OFF -DANIMEME_BUILD_TESTS=OFF -DANIMEME_BUILD_C=${shared})
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME animeme CONFIG_PATH lib/cmake/animeme)
if(shared)
  vcpkg_fixup_pkgconfig()
endif()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
