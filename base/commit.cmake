# cmake -D SOURCE=DIR -D FILE=F -P commit.cmake: what `--version` says of the sources in DIR, as a definition in F, which
# is written when it changes.
cmake_minimum_required(VERSION 3.22)
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --exclude=* --abbrev=12
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "not known")
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT "#define GAUNTLET_COMMIT \"@commit@\"\n" @ONLY)
