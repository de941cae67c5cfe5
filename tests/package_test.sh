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
    ./usr/share/bentaxis/cases/bap63_rated.toml ./usr/share/bentaxis/reference_data/README.md ./usr/share/man/man1/bentaxis.1.gz \
    ./usr/share/bash-completion/completions/bentaxis ./usr/share/doc/bentaxis/copyright ./usr/share/doc/bentaxis/changelog.Debian.gz ./usr/share/doc/bentaxis/LICENSE ./usr/share/doc/bentaxis/docs/theory.md; do
  grep -qxF "$file" content || { echo "not in the package: $file"; exit 1; }
done
# With the site goes its search; pages that were built without it lack nothing else.
if grep -qxF ./usr/share/doc/bentaxis/site/index.html content; then
  grep -qxF ./usr/share/doc/bentaxis/site/assets/search_index.js content || { echo "the site lacks its search"; exit 1; }
fi
# Nothing of the tests, nothing outside of /usr.
if grep -E '_test|\.pyc$|/tests/' content || grep -vE '^\./(usr/.*)?$' content; then
  echo "in the package, and should not be"
  exit 1
fi
field() { dpkg-deb -f "$package" "$1"; }
[[ $(field Package) == bentaxis ]]
[[ $(field Version) == $(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt") ]]
# What is linked, and what is loaded at run time.
for library in libsimbody librsvg2-2 libtbb libpugixml libmatio $(grep -q dist-packages content && echo python3-numpy); do
  grep -q "$library" <<< "$(field Depends)" || { echo "Depends lacks $library: $(field Depends)"; exit 1; }
done
# A maintainer and a home page are true or not there: no address that stands for one.
maintainer=$(field Maintainer)
[[ -n $maintainer ]] || { echo "Maintainer is missing"; exit 1; }
for value in "$maintainer" "$(field Homepage)"; do
  if grep -qiE 'example|invalid|localhost|noreply|changeme|your' <<< "$value"; then
    echo "is a placeholder: $value"
    exit 1
  fi
done
# What dpkg makes of the changelog and, as far as this is here, of the package.
dpkg-deb -x "$package" root
documents=root/usr/share/doc/bentaxis
gzip -dc $documents/changelog.Debian.gz > changelog
version=$(dpkg-parsechangelog -l changelog -S Version 2> parsed) || { cat parsed; exit 1; }
[[ $version == $(field Version) && ! -s parsed ]] || { echo "changelog: $version"; cat parsed changelog; exit 1; }
[[ $(dpkg-parsechangelog -l changelog -S Source) == bentaxis ]]
[[ $(dpkg-parsechangelog -l changelog -S Maintainer) == "$maintainer"* ]]
if grep -qi example changelog; then echo "placeholder in the changelog"; exit 1; fi
# The machine-readable form of copyright files: its first line, and a licence for all files.
[[ $(head -n 1 $documents/copyright) == 'Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/' ]]
grep -qx 'Files: \*' $documents/copyright
[[ $(grep -cx 'License: Apache-2.0' $documents/copyright) == 2 ]]
grep -q '^Copyright: ' $documents/copyright
# Notices of what the package carries.
for part in three.js dygraphs SUNDIALS Boost Eigen; do
  grep -q "^ ==== $part ====" $documents/copyright || { echo "copyright lacks $part"; exit 1; }
done
# Debian's checker: errors fail, but for those of a maintainer without an address (BENTAXIS_PACKAGE_CONTACT).
if command -v lintian > /dev/null; then
  lintian --fail-on error --suppress-tags malformed-contact,bogus-mail-host-in-debian-changelog "$package" > lintian.log ||
    { grep '^E:' lintian.log; exit 1; }
fi
# Sanitized or not, the program of the package runs where it lies.
root/usr/bin/bentaxis --version > /dev/null
echo "$(wc -l < content) entries"
