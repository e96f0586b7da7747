# check_layers.cmake must find what is wrong in broken/.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${CMAKE_CURRENT_LIST_DIR}/broken -DLEAST=1
                        -P ${CMAKE_CURRENT_LIST_DIR}/check_layers.cmake
                RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result EQUAL 0)
    message(FATAL_ERROR "the broken tree passed")
endif()
foreach(expected
        "core/upward.h includes sh/basis.h, which core/ may not"
        "envmap/leaky.h is public and includes <OpenImageIO/imageio.h>"
        "envmap/leaky.h is public and includes envmap/private.h, which is not"
        "sh/loader.cpp includes <OpenImageIO/imageio.h>, which sh/ may not"
        "sh/loader.cpp includes \"basis.h\" without its folder")
    string(FIND "${output}" "${expected}" place)
    if(place EQUAL -1)
        message(FATAL_ERROR "not found: ${expected}\n${output}")
    endif()
endforeach()
