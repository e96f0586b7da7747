# One way to declare every target of the project.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

add_library(airlight_options INTERFACE)
target_compile_features(airlight_options INTERFACE cxx_std_17)
# Contraction would make results depend on the compiler's choices: fused operations are written out.
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i[3-6]86")
    # Vectors without a size at compile time cannot be members or elements; NEON remains.
    target_compile_definitions(airlight_options INTERFACE
        "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV)")
endif()
target_compile_options(airlight_options INTERFACE -Wall -Wextra -Wshadow -ffp-contract=off)
if(AIRLIGHT_SANITIZE)
    target_compile_options(airlight_options INTERFACE
                           -fsanitize=${AIRLIGHT_SANITIZE} -fno-omit-frame-pointer -g)
    target_link_options(airlight_options INTERFACE -fsanitize=${AIRLIGHT_SANITIZE})
endif()

# airlight_library(NAME SOURCES ... HEADERS ... PUBLIC libs... PRIVATE libs...)
# makes the static library airlight_NAME with the alias airlight::NAME and installs its headers.
function(airlight_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
    set(target airlight_${name})
    add_library(${target} STATIC ${ARG_SOURCES})
    add_library(airlight::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} CXX_EXTENSIONS OFF
                          POSITION_INDEPENDENT_CODE ON)
    target_include_directories(${target} PUBLIC
        "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>"
        "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>"
        "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/airlight>")
    target_compile_features(${target} PUBLIC cxx_std_17)
    target_link_libraries(${target} PUBLIC ${ARG_PUBLIC}
                          PRIVATE ${ARG_PRIVATE} "$<BUILD_INTERFACE:airlight_options>")
    install(TARGETS ${target} EXPORT airlightTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    foreach(header ${ARG_HEADERS})
        install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/airlight/${name})
    endforeach()
    set_property(GLOBAL APPEND PROPERTY AIRLIGHT_LIBRARIES ${name})
endfunction()

# airlight_test(NAME SOURCES ... LIBS ...) makes one GoogleTest program, one CTest entry per test.
function(airlight_test name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
    add_executable(${name} ${ARG_SOURCES})
    set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF)
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} PRIVATE ${ARG_LIBS} airlight_options GTest::gtest_main)
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60)
endfunction()

# Writes and installs the package files that make find_package(airlight) work.
function(airlight_install)
    install(EXPORT airlightTargets NAMESPACE airlight::
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/airlight)
    configure_package_config_file(
        ${PROJECT_SOURCE_DIR}/cmake/airlightConfig.cmake.in
        ${PROJECT_BINARY_DIR}/airlightConfig.cmake
        INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/airlight)
    write_basic_package_version_file(${PROJECT_BINARY_DIR}/airlightConfigVersion.cmake
                                     COMPATIBILITY SameMinorVersion)
    install(FILES ${PROJECT_BINARY_DIR}/airlightConfig.cmake
                  ${PROJECT_BINARY_DIR}/airlightConfigVersion.cmake
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/airlight)
endfunction()
