# Writes HEADER with SLURRY_VERSION: VERSION, and what git says of the tree in SOURCE when that is a repository.
# A header that would not change is left alone, so nothing is rebuilt.
cmake_minimum_required(VERSION 3.25)
set(version ${VERSION})
set(ENV{GIT_OPTIONAL_LOCKS} 0) # a build must not disturb a git command that runs at the same time
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-toplevel
    OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(NOT failed AND top STREQUAL SOURCE) # else: an unpacked archive, perhaps inside somebody else's repository
    execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --match v*
        OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    if(described MATCHES "^v[0-9]")
        string(SUBSTRING ${described} 1 -1 version)
    elseif(NOT failed)
        string(APPEND version "+" ${described})
    endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define SLURRY_VERSION \"@version@\"\n" @ONLY)
