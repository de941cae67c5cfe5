# Joins the objects of an archive with what they need of some static libraries, and makes every
# symbol of these libraries local:
#   -DOUTPUT=x.o -DARCHIVE=x.a "-DLIBRARIES=a.a;b.a" -DLINKER= -DNM= -DOBJCOPY=
# Used by numerics/: Simbody exports functions of its own old copy of SUNDIALS (N_VNew_Serial and a
# hundred more), and whichever library the loader finds first would serve both.
set(symbols "")
foreach(library IN LISTS LIBRARIES)
  execute_process(COMMAND ${NM} --defined-only --extern-only --format=posix ${library}
    OUTPUT_VARIABLE text ERROR_QUIET COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" lines "${text}")
  list(FILTER lines INCLUDE REGEX "^[A-Za-z_][A-Za-z_0-9]* [A-Z] ")
  list(TRANSFORM lines REPLACE " .*" "")
  list(APPEND symbols ${lines})
endforeach()
list(REMOVE_DUPLICATES symbols)
list(JOIN symbols "\n" text)
file(WRITE ${OUTPUT}.symbols "${text}\n")
execute_process(COMMAND ${LINKER} -r -o ${OUTPUT}
  --whole-archive ${ARCHIVE} --no-whole-archive --start-group ${LIBRARIES} --end-group
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${OBJCOPY} --localize-symbols=${OUTPUT}.symbols ${OUTPUT}
  COMMAND_ERROR_IS_FATAL ANY)
