#!/usr/bin/env bash
# Fails where the library of a unit needs more than libc and libm, shows more than FMI's functions, or names a
# path of the computer that built it.
# usage: fmu_library_test.sh LIBRARY SOURCE_FOLDER
set -euo pipefail
library=$1
sources=$2
status=0
say() { echo "error: $1"; status=1; }

needed=$(readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
for name in $needed; do
  case $name in
    libc.so.6 | libm.so.6 | ld-linux-*) ;;
    *) say "needs $name" ;;
  esac
done
[ -n "$needed" ] || say "nothing is needed, not even libc: is this the library?"
if grep -qE 'RPATH|RUNPATH|TEXTREL' <<< "$(readelf -d "$library")"; then say "has a run path or text relocations"; fi

shown=$(nm -D --defined-only "$library" | awk '{print $NF}' | sed 's/@.*//')
others=$(grep -vE '^fmi[23][A-Z]' <<< "$shown" || true)
[ -z "$others" ] || say "shows $others"
for version in 2 3; do
  names=$(printf '#include "%s"\n#define SHOW(result, name, arguments) @name@\nBENTAXIS_FMI%s_FUNCTIONS(SHOW)\n' \
    "$sources/interfaces/fmu/interface/fmi$version.h" $version | c++ -std=c++20 -E -P -x c++ - | grep -oE '@ *fmi[A-Za-z0-9]+ *@' | tr -d '@ ')
  [ "$(wc -w <<< "$names")" = "$(grep -c "^fmi$version" <<< "$shown")" ] || say "has not as many functions of FMI $version as fmi$version.h"
  for name in $names; do
    grep -qx "$name" <<< "$shown" || say "lacks $name"
  done
done
unknown=$(nm -D --undefined-only "$library" | awk '$1 == "U" {print $2}' | grep -v '@GLIBC_' || true)
[ -z "$unknown" ] || say "needs symbols that are not libc's: $unknown"
# The version of glibc that the documents state is the one that the symbols need.
least=$(nm -D --undefined-only "$library" | grep -oE '@GLIBC_[0-9.]+' | sed 's/@GLIBC_//' | sort -V | tail -n 1)
newest=2.28  # of the oldest systems that simulators are still delivered for
[ "$(printf '%s\n' "$least" $newest | sort -V | tail -n 1)" = $newest ] || say "needs glibc $least, which is newer than $newest"
for page in fmu limits; do
  stated=$(grep -oE 'glibc [0-9]+\.[0-9]+' "$sources/docs/$page.md" | sort -u)
  [ "$stated" = "glibc $least" ] || say "docs/$page.md states \"$stated\", the library needs glibc $least"
done
if strings -a "$library" | grep -F "$sources/"; then say "names paths of the sources"; fi
if [ -n "$(nm "$library" 2>/dev/null)" ]; then say "has symbols that are for debuggers"; fi
[ $status = 0 ] && echo "libc and libm, $(wc -l <<< "$shown") functions of FMI"
exit $status
