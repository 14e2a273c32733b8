# cmake -DSPIRV_OPT=... -DINPUT=x.spv -DOUTPUT=x.h -DNAME=x -P embed_shader.cmake: a shader as an array of C++.
#
# Its functions are put where they are called, and what is then never read is dropped: Mesa's CPU driver does that for every
# pipeline, cached or not, which is half of a warm start. These passes leave all arithmetic as it is, to the bit; -Os of
# glslangValidator does not.
execute_process(COMMAND ${SPIRV_OPT} --target-env=vulkan1.3 --scalar-block-layout --inline-entry-points-exhaustive
        --eliminate-dead-functions --eliminate-local-single-block --eliminate-local-single-store --eliminate-dead-code-aggressive
        ${INPUT} -o ${INPUT}
    OUTPUT_VARIABLE messages ERROR_VARIABLE messages RESULT_VARIABLE result) # it names every function that stays one
if(NOT result EQUAL 0)
    message(FATAL_ERROR "${INPUT}: ${messages}")
endif()
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
file(WRITE ${OUTPUT} "const std::uint32_t ${NAME}[] = {${words}};\n")
