#!/usr/bin/env bash
# Fails if a kernel built for one instruction set defines a symbol that the linker could take for
# another's: such a function would be run on processors that lack the instructions.
# usage: batch_symbols_test.sh ANALYTIC_LIBRARY
set -euo pipefail
library=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

shared_symbols() {  # object, instruction set: names defined for the linker without the set's name
  nm -C --defined-only "$1" | grep -E ' [A-Zu] ' | grep -vE "DW\.ref\.|$2" || true
}

cd "$scratch"
status=0
for set in sse2 avx2 avx512; do
  ar x "$library" "$set.cpp.o"
  # Names first, then the look: `grep -q` ends at its first find, and a pipe that it leaves counts as failed.
  names=$(nm -C --defined-only "$set.cpp.o")
  if ! grep -q "run_batch_$set" <<< "$names"; then
    echo "error: no kernel for $set"; status=1
  fi
  found=$(shared_symbols "$set.cpp.o" "$set")
  if [ -n "$found" ]; then
    echo "error: the kernel for $set defines"; echo "$found"; status=1
  fi
done
# The check itself must be able to fail: this object's symbols are not avx512's.
if [ -z "$(shared_symbols avx2.cpp.o avx512)" ]; then
  echo "error: the check does not notice a shared symbol"; status=1
fi
[ $status = 0 ] && echo "kernels share no symbol"
exit $status
