#!/usr/bin/env bash
# The program starts and computes under valgrind, which emulates long double as double: nothing that runs before main() may
# need the wider one. Errors in memory count too.
#   valgrind_test.sh BENTAXIS REPO_ROOT
set -euo pipefail
program=$1 root=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
run() {
  # Libraries that others start with may err; our own code is on the stack of what counts.
  valgrind --quiet --error-exitcode=99 --leak-check=no --exit-on-first-error=no "$program" "$@" > "$folder/said" 2>&1 ||
    { status=$?; echo "valgrind: bentaxis $*: status $status" >&2; cat "$folder/said" >&2; exit 1; }
}
run --version
grep -q '^bentaxis [0-9]' "$folder/said"
run run "$root/cases/bap63_rated.toml" --model analytic --set operation.samples_per_revolution=3 --out "$folder/out"
[[ $(wc -l < "$folder/out/analytic.csv") == 4 ]]
