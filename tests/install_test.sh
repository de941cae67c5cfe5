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
# One module of it, without what the others need; and a module there is not.
cmake -S "$source_dir/tests/install/components" -B "$scratch/components" -DCMAKE_PREFIX_PATH="$scratch/usr" \
  -DCMAKE_BUILD_TYPE=Release > "$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
cmake --build "$scratch/components" > "$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
"$scratch/components/uses_analytic"
if cmake -S "$source_dir/tests/install/components" -B "$scratch/unknown" -DCMAKE_PREFIX_PATH="$scratch/usr" -DMODULE=analitic \
    > "$scratch/log" 2>&1; then
  echo "an unknown component was found"
  exit 1
fi
grep -q 'no component "analitic": there are pump' <(tr -s '\n ' ' ' < "$scratch/log") || { cat "$scratch/log"; exit 1; }
# The document names every component.
named=$(sed -n '/^Components:/,/^$/p' "$source_dir/docs/install.md")
for component in $(sed -n 's/^set(bentaxis_modules \(.*\))$/\1/p' "$build/bentaxisConfig.cmake" | tr ';' ' '); do
  grep -qF "\`$component\`" <<< "$named" || { echo "docs/install.md: no component $component"; exit 1; }
done
cd "$scratch"
LD_DEBUG=files LD_DEBUG_OUTPUT=$scratch/loaded \
  "$scratch/build/uses_bentaxis" "$source_dir/cases/bap63_rated.toml" "$source_dir/cases/bap63_rated_hydraulic.toml"
# It sweeps; HDF5 is written by a module, which stands where the library was installed.
if [[ -f $build/modules/bentaxis_hdf5.so ]]; then
  grep -q "calling init: $scratch/usr/lib/bentaxis/bentaxis_hdf5.so" loaded.* ||
    { echo "a program with the installed library does not find its modules"; exit 1; }
fi
share=usr/share
for file in doc/bentaxis/{LICENSE,README.md,CHANGELOG.md,docs/command_line.md} man/man1/bentaxis.1.gz \
    bash-completion/completions/bentaxis zsh/site-functions/_bentaxis fish/vendor_completions.d/bentaxis.fish; do
  test -s "$share/$file" || { echo "not installed: $file"; exit 1; }
done
usr/bin/bentaxis manual | cmp - <(gzip -dc $share/man/man1/bentaxis.1.gz)
usr/bin/bentaxis completion bash | cmp - $share/bash-completion/completions/bentaxis
# Every link of an installed document leads to a file that is installed; and the check notices one that does not.
dead_links() {
  /usr/bin/python3 -B - "$source_dir/scripts" "$1" <<'EOF'
import pathlib, sys
sys.path.insert(0, sys.argv[1])
from documentation import links
print("\n".join(links.wrong_in_markdown(pathlib.Path(sys.argv[2]))))
EOF
}
wrong=$(dead_links $share/doc/bentaxis)
[[ -z $wrong ]] || { echo "installed documents: $wrong"; exit 1; }
mv $share/doc/bentaxis/docs/limits.md .
wrong=$(dead_links $share/doc/bentaxis)
[[ $wrong == *README.md*limits.md:\ no\ such\ file* ]] || { echo "a dead link is not noticed"; exit 1; }
mv limits.md $share/doc/bentaxis/docs/
# The documentation: the site where it was built, else how it is built.
if [[ -f $share/doc/bentaxis/site/index.html ]]; then
  [[ $(usr/bin/bentaxis docs --print) -ef $share/doc/bentaxis/site/index.html ]]
fi
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
