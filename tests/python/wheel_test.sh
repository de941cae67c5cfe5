#!/usr/bin/env bash
# An sdist, a wheel of it, and an environment that the wheel is installed into, without a network.
# usage: wheel_test.sh SOURCE_DIR [BUILD_DIR]    without BUILD_DIR pip compiles everything
set -euo pipefail
source_dir=$1 build=${2:-}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
fail() { echo "$1"; exit 1; }
python=/usr/bin/python3
pip() { PIP_NO_INDEX=1 PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_ROOT_USER_ACTION=ignore $python -B -m pip "$@"; }
with=()
[[ -z $build ]] || with=(--config-settings "build=$build")

mkdir dist
PYTHONPATH=$source_dir/scripts $python -B -c 'import python_wheel, sys; python_wheel.build_sdist(sys.argv[1])' dist
sdist=$(echo dist/bentaxis-*.tar.gz)
pip wheel --no-deps "${with[@]}" -w from_sdist "$sdist" > log 2>&1 || { cat log; exit 1; }
wheel=$(echo from_sdist/bentaxis-*.whl)
if [[ -n $build ]]; then
  # The repository gives the same bytes, with or without pip's isolation of the build.
  pip wheel --no-deps --no-build-isolation "${with[@]}" -w from_repository "$source_dir" > log 2>&1 || { cat log; exit 1; }
  cmp "$wheel" from_repository/*.whl
fi

# An environment that sees Debian's numpy.
$python -m venv --system-site-packages --without-pip environment
pip --python environment/bin/python install "$wheel" > log 2>&1 || { cat log; exit 1; }
environment/bin/python - "$scratch/environment" <<'END'
import importlib.metadata, pathlib, sys
import bentaxis
environment = pathlib.Path(sys.argv[1])
assert environment in pathlib.Path(bentaxis.__file__).parents, bentaxis.__file__
assert pathlib.Path(bentaxis.data_folder()) == environment / "share/bentaxis/cases", bentaxis.data_folder()
assert importlib.metadata.version("bentaxis") == bentaxis.__version__
folder = pathlib.Path(bentaxis.__file__).parent
assert (folder / "py.typed").is_file() and (folder / "__init__.pyi").is_file()
assert bentaxis.compare(bentaxis.read_case(bentaxis.data_folder() + "/bap63_rated.toml")).agrees
END
environment/bin/bentaxis cases > cases.program
environment/bin/python -m bentaxis cases > cases.module
grep -q bap63_rated cases.program
cmp cases.program cases.module
status=0
environment/bin/python -m bentaxis run no_such_case --out out > log 2>&1 || status=$?
[[ $status == 2 ]] || fail "python -m bentaxis: exit status $status, not that of the program"
pip --python environment/bin/python uninstall -y bentaxis > log 2>&1
left=$(find environment -path '*bentaxis*' -not -path '*__pycache__*' -type f)
[[ -z $left ]] || fail "left after pip uninstall: $left"

# A missing package is named in one line, and no wheel is left.
mkdir without
cat > without/dpkg-query <<'END'
#!/bin/sh
/usr/bin/dpkg-query "$@" | sed '/^pybind11-dev /s/installed$/config-files/'
END
chmod +x without/dpkg-query
if PATH=$scratch/without:$PATH pip wheel --no-deps "${with[@]}" -w none "$source_dir" > log 2>&1; then
  fail "a missing package is not noticed"
fi
grep -q 'bentaxis: missing Debian packages, to be installed by root: apt-get install pybind11-dev$' log || { cat log; exit 1; }
if grep -q Traceback log || compgen -G "none/*.whl" > /dev/null; then
  cat log
  exit 1
fi
# A folder that is no build is refused.
if pip wheel --no-deps --config-settings build="$scratch" -w none "$source_dir" > log 2>&1; then
  fail "a folder without a build is not noticed"
fi
grep -q "bentaxis: --config-settings build=$scratch: is not the folder of a build" log || { cat log; exit 1; }
