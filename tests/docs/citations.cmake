# Every [Key] cited in a comment of a header or source has an entry in docs/REFERENCES.md.
#
# A key is a name with two digits for the year ([Sun05]) or a name of at least four letters ([DLMF]),
# begins with a capital, and may be followed by a place within the brackets ([DLMF 6.2.1]). Units and
# intervals in comments, such as [rad] or [T, 1], are none of that, and code is not looked at.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/text.cmake)

set(key "[A-Z][A-Za-z]+[0-9][0-9]|[A-Z][A-Za-z][A-Za-z][A-Za-z]+")

read_text(${ROOT}/docs/REFERENCES.md references)
string(REGEX MATCHALL "\n[*][*]${OPEN}(${key})${CLOSE}[*][*] " entries "${references}")
set(known)
foreach(entry IN LISTS entries)
    string(REGEX MATCH "(${key})" name "${entry}")
    list(APPEND known ${name})
endforeach()

set(count 0)
set(problems)
project_files(files *.h *.cpp)
foreach(file IN LISTS files)
    read_text(${file} text)
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${ROOT})
    string(REGEX MATCHALL "//[^\n]*" comments "${text}")
    string(REGEX MATCHALL "${OPEN}(${key})( [^${CLOSE}\n]*)?${CLOSE}" citations "${comments}")
    foreach(citation IN LISTS citations)
        string(REGEX MATCH "(${key})" name "${citation}")
        math(EXPR count "${count} + 1")
        if(NOT name IN_LIST known)
            list(APPEND problems "${file} cites ${name}, which docs/REFERENCES.md lacks")
        endif()
    endforeach()
endforeach()
conclude("citations" ${count} "${problems}")
