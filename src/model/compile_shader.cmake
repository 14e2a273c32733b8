# cmake -DGLSLANG=... -DSPIRV_OPT=... -DSTAGE=x.vert -DFLAGS="-I... -D..." -DCACHE=FOLDER -DOUTPUT=x.spv -P compile_shader.cmake: a
# stage as SPIR-V. What is the same text after its preprocessor is compiled once and kept in CACHE: variants of a stage that do not
# differ, the other preset's, and all that an edited header does not change.
#
# Its functions are put where they are called, and what is then never read is dropped: Mesa's CPU driver does that for every
# pipeline, cached or not, which is half of a warm start. These passes leave all arithmetic as it is, to the bit; -Os of
# glslangValidator does not.
separate_arguments(FLAGS)
set(compiler ${GLSLANG} -V --quiet --target-env vulkan1.3)
set(optimizer ${SPIRV_OPT} --target-env=vulkan1.3 --scalar-block-layout --inline-entry-points-exhaustive
    --eliminate-dead-functions --eliminate-local-single-block --eliminate-local-single-store --eliminate-dead-code-aggressive
    --eliminate-dead-branches --merge-blocks --scalar-replacement=100 --ssa-rewrite --eliminate-dead-code-aggressive)

# Errors carry the file and line.
function(call program)
    execute_process(COMMAND ${program} ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE words ERROR_VARIABLE errors)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${words}${errors}")
    endif()
    set(words "${words}" PARENT_SCOPE)
endfunction()

# The key: the preprocessed text, the kind of stage, the commands, and the programs by their size and time.
call(${GLSLANG} -E ${FLAGS} ${STAGE})
get_filename_component(kind ${STAGE} LAST_EXT)
file(SIZE ${GLSLANG} glslangSize)
file(SIZE ${SPIRV_OPT} optimizerSize)
file(TIMESTAMP ${GLSLANG} glslangTime)
file(TIMESTAMP ${SPIRV_OPT} optimizerTime)
string(REGEX REPLACE "[^\n]*#line[^\n]*" "" text "${words}") # paths
string(SHA256 key "${kind}|${compiler}|${optimizer}|${glslangSize} ${glslangTime} ${optimizerSize} ${optimizerTime}|${text}")

set(kept ${CACHE}/${key}.spv)
if(NOT EXISTS ${kept})
    # Under a name of its own until it is whole: two of ninja's jobs may compile the same.
    file(MAKE_DIRECTORY ${CACHE})
    string(RANDOM LENGTH 12 suffix)
    call(${compiler} ${FLAGS} -o ${kept}.${suffix} ${STAGE})
    call(${optimizer} ${kept}.${suffix} -o ${kept}.${suffix}) # it names every function that stays one
    file(RENAME ${kept}.${suffix} ${kept})
endif()
file(COPY_FILE ${kept} ${OUTPUT})
