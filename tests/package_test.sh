#!/usr/bin/env bash
# The Debian package of a finished build: what it holds and needs.
# usage: package_test.sh BUILD_DIR
set -euo pipefail
build=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# Fast compression: what is looked at is the content.
cd "$scratch"
cpack -G DEB --config "$build/CPackConfig.cmake" -B "$scratch/package" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip \
  -D CPACK_PACKAGE_DIRECTORY="$scratch/package" > log 2>&1 || { cat log; exit 1; }
package=$(ls package/bentaxis_*_*.deb)
dpkg-deb -c "$package" | awk '{print $6}' > content
for file in ./usr/bin/bentaxis ./usr/include/bentaxis/analytic/model.h ./usr/lib/libbentaxis_analytic.a \
    ./usr/lib/cmake/bentaxis/bentaxisConfig.cmake ./usr/lib/cmake/bentaxis/bentaxis-analytic.cmake \
    ./usr/share/bentaxis/cases/bap63_rated.toml ./usr/share/bentaxis/reference_data/README.md ./usr/share/man/man1/bentaxis.1 \
    ./usr/share/bash-completion/completions/bentaxis ./usr/share/doc/bentaxis/copyright ./usr/share/doc/bentaxis/docs/theory.md; do
  grep -qxF "$file" content || { echo "not in the package: $file"; exit 1; }
done
# Nothing of the tests, nothing outside of /usr.
if grep -E '_test|\.pyc$|/tests/' content || grep -vE '^\./(usr/.*)?$' content; then
  echo "in the package, and should not be"
  exit 1
fi
field() { dpkg-deb -f "$package" "$1"; }
[[ $(field Package) == bentaxis ]]
[[ $(field Version) == $(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt") ]]
# What is linked, and what is loaded at run time.
for library in libsimbody librsvg2-2 libtbb libpugixml $(grep -q dist-packages content && echo python3-numpy); do
  field Depends | grep -q "$library" || { echo "Depends lacks $library: $(field Depends)"; exit 1; }
done
# Sanitized or not, the program of the package runs where it lies.
dpkg-deb -x "$package" root
root/usr/bin/bentaxis --version > /dev/null
echo "$(wc -l < content) entries"
