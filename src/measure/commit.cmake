# Names the source that is built; the file changes only where that does.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 "--exclude=*" OUTPUT_VARIABLE commit
    RESULT_VARIABLE result OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT result EQUAL 0)
    set(commit unknown)
endif()
configure_file(${SOURCE}/src/measure/commit.cpp.in ${BINARY}/commit.cpp @ONLY)
