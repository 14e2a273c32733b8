# Installs into a fresh folder, builds README.md's example against it and runs it: cmake -DSOURCE= -DBINARY= -DCONFIG=
# -P install_test.cmake
cmake_minimum_required(VERSION 3.25)
set(work ${BINARY}/install-test)
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${work}/run)

macro(step name)
    message(STATUS "${name}")
    execute_process(${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE words ERROR_VARIABLE words)
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "${name} failed: ${code}\n${words}")
    endif()
endmacro()

step("install" COMMAND ${CMAKE_COMMAND} --install ${BINARY} --config ${CONFIG} --prefix ${work}/prefix)
foreach(file bin/relief include/relief/relief.h include/relief/frame/frame.h include/relief/shared/surface.h
        lib/librelief_frame.a lib/cmake/relief/reliefConfigVersion.cmake)
    if(NOT EXISTS ${work}/prefix/${file})
        message(FATAL_ERROR "${file} was not installed")
    endif()
endforeach()
# The package must not depend on the folders it was built in.
file(GLOB packageFiles ${work}/prefix/lib/cmake/relief/*.cmake)
foreach(file ${packageFiles})
    file(STRINGS ${file} lines)
    if("${lines}" MATCHES "${SOURCE}/")
        message(FATAL_ERROR "${file} names the source folder")
    endif()
endforeach()

# The first block of C++ in README.md.
file(READ ${SOURCE}/README.md readme)
string(FIND "${readme}" "```cpp\n" start)
if(start EQUAL -1)
    message(FATAL_ERROR "README.md has no ```cpp block")
endif()
math(EXPR start "${start} + 7")
string(SUBSTRING "${readme}" ${start} -1 example)
string(FIND "${example}" "```" length)
string(SUBSTRING "${example}" 0 ${length} example)
file(WRITE ${work}/example.cpp "${example}")

step("configure" COMMAND ${CMAKE_COMMAND} -S ${SOURCE}/tests/install -B ${work}/build -G Ninja
    -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_PREFIX_PATH=${work}/prefix -DEXAMPLE=${work}/example.cpp)
step("build" COMMAND ${CMAKE_COMMAND} --build ${work}/build)

# The files that the example names.
file(COPY ${SOURCE}/meshes/torus.obj DESTINATION ${work}/run)
step("paint a map" COMMAND ${BINARY}/make_maps ${work}/run smooth)
file(RENAME ${work}/run/smooth.exr ${work}/run/map.exr)
step("run" COMMAND ${work}/build/example WORKING_DIRECTORY ${work}/run)
if(words MATCHES "vulkan:") # RELIEF_VALIDATE=1 prints what the validation layer finds
    message(FATAL_ERROR "${words}")
endif()
step("look" COMMAND ${work}/prefix/bin/relief info --json torus.png WORKING_DIRECTORY ${work}/run)
foreach(part "\"width\": 256" "\"height\": 256" "\"format\": \"png\"")
    if(NOT words MATCHES "${part}")
        message(FATAL_ERROR "the example's picture is not what it should be:\n${words}")
    endif()
endforeach()
