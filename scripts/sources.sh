# shellcheck shell=bash
# Sourced by the other scripts.

# Our own files with the given endings, below the current directory, separated by null characters.
our_sources() {
  local names=() ending
  for ending in "$@"; do names+=(-o -name "*.$ending"); done
  find . \( -path './build*' -o -path ./out -o -path './.*' \) -prune -o -type f \( "${names[@]:1}" \) -print0 | sort -z
}
