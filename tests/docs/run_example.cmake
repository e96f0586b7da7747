# Runs the README's program in a folder that holds its input, room.exr.
cmake_minimum_required(VERSION 3.25)
file(REMOVE ${FOLDER}/foggy.exr)
file(COPY_FILE ${MAP} ${FOLDER}/room.exr)
execute_process(COMMAND ${PROGRAM} WORKING_DIRECTORY ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
file(SIZE ${FOLDER}/foggy.exr bytes)
if(bytes EQUAL 0)
    message(FATAL_ERROR "foggy.exr is empty")
endif()
