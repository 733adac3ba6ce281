# Writes OUTPUT, a source file that holds the commit of SOURCE_DIR: 40 hex digits, with "-dirty" when tracked files differ
# from it, or "unknown" outside git. The file is left alone when nothing changed.
set(hash unknown)
find_package(Git QUIET)
if(GIT_FOUND)
  set(ENV{GIT_OPTIONAL_LOCKS} 0)
  # A source tree without .git inside some other repository must not take that one's hash.
  execute_process(COMMAND ${GIT_EXECUTABLE} rev-parse --show-prefix WORKING_DIRECTORY ${SOURCE_DIR}
                  RESULT_VARIABLE failed OUTPUT_VARIABLE prefix ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT failed AND prefix STREQUAL "")
    execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --abbrev=40 --exclude=* --dirty
                    WORKING_DIRECTORY ${SOURCE_DIR}
                    RESULT_VARIABLE failed OUTPUT_VARIABLE described ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(NOT failed)
      set(hash ${described})
    endif()
  endif()
endif()

set(text "namespace pregrasp::internal {\nextern const char* const kGitHash = \"${hash}\";\n}\n")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT text STREQUAL "${old}")
  file(WRITE ${OUTPUT} "${text}")
endif()
