#!/usr/bin/env bash
# Installs the build into an empty folder, builds a program against it and runs both.
# usage: install_test.sh BUILD_DIR SOURCE_DIR
set -euo pipefail
build=$1 source_dir=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cmake --install "$build" --prefix "$scratch/usr" > /dev/null
cmake -S "$source_dir/tests/install" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$scratch/usr" \
  -DCMAKE_BUILD_TYPE=Release > "$scratch/log" || { cat "$scratch/log"; exit 1; }
cmake --build "$scratch/build" > "$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
# One room of it, without what the others need; and a room there is not.
cmake -S "$source_dir/tests/install/components" -B "$scratch/components" -DCMAKE_PREFIX_PATH="$scratch/usr" \
  -DCMAKE_BUILD_TYPE=Release > "$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
cmake --build "$scratch/components" > "$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
"$scratch/components/uses_analytic"
if cmake -S "$source_dir/tests/install/components" -B "$scratch/unknown" -DCMAKE_PREFIX_PATH="$scratch/usr" -DROOM=analitic \
    > "$scratch/log" 2>&1; then
  echo "an unknown component was found"
  exit 1
fi
grep -q 'no component "analitic": there are pump' <(tr -s '\n ' ' ' < "$scratch/log") || { cat "$scratch/log"; exit 1; }
cd "$scratch"
"$scratch/build/uses_bentaxis" "$source_dir/cases/bap63_rated.toml" "$source_dir/cases/bap63_rated_hydraulic.toml"
share=usr/share
for file in doc/bentaxis/{LICENSE,README.md,CHANGELOG.md,docs/command_line.md} man/man1/bentaxis.1 \
    bash-completion/completions/bentaxis zsh/site-functions/_bentaxis fish/vendor_completions.d/bentaxis.fish; do
  test -s "$share/$file" || { echo "not installed: $file"; exit 1; }
done
usr/bin/bentaxis manual | cmp - $share/man/man1/bentaxis.1
usr/bin/bentaxis completion bash | cmp - $share/bash-completion/completions/bentaxis
# Every file that README.md links to is installed beside it.
grep -o '](\([^)#:]\)*[)#]' $share/doc/bentaxis/README.md | cut -c3- | tr -d ')#' > "$scratch/links"
test "$(wc -l < "$scratch/links")" -ge 15 || { echo "README.md: too few links found"; exit 1; }
while read -r page; do
  test -s "$share/doc/bentaxis/$page" || { echo "README.md: $page is not installed"; exit 1; }
done < "$scratch/links"
usr/bin/bentaxis compare usr/share/bentaxis/cases/bap63_rated.toml --out out > /dev/null
usr/bin/bentaxis hardcases --filter tilt_45 --out out > /dev/null
ls out/report.html out/hardcases.html
# The Python module, where it was built, finds what is installed with it.
packages=$scratch/usr/lib/python3/dist-packages
if [[ -d $packages/bentaxis ]]; then
  PYTHONPATH=$packages /usr/bin/python3 - "$scratch/usr/share/bentaxis" <<'EOF'
import pathlib, sys
import bentaxis
assert pathlib.Path(bentaxis.data_folder()) == pathlib.Path(sys.argv[1]) / "cases", bentaxis.data_folder()
assert bentaxis.compare(bentaxis.read_case(bentaxis.data_folder() + "/bap63_rated.toml")).agrees
EOF
fi
