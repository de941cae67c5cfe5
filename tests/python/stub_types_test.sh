#!/usr/bin/env bash
# The stub of the Python module by mypy --strict, and what it says of a program that uses it: nothing where types are
# right, something where they are wrong.
# usage: stub_types_test.sh SOURCE_FOLDER
set -euo pipefail
sources=$1
command -v mypy > /dev/null || { echo "mypy is missing: apt-get install mypy"; exit 1; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
check() { mypy --strict --python-executable /usr/bin/python3 --cache-dir "$scratch/cache" "$@"; }
check "$sources/interfaces/python/bentaxis/__init__.pyi"

cat > right.py << 'END'
import bentaxis
import numpy

case = bentaxis.read_case("case.toml", {"pump.tilt_deg": 38})
table: bentaxis.Table = bentaxis.run(case, channels=["Td"])
torque = table["Td"] if "Td" in table else numpy.asarray(table)[:, 1]
mean: float = float(torque.mean())
texts: list[str] = table.warnings + bentaxis.compare(case).warnings
keys: list[str] = [key for key, _ in case.items()]
try:
    bentaxis.simulate(case, error=1e-5)
except bentaxis.PlausibilityWarning:
    pass
END
cat > wrong.py << 'END'
import bentaxis

case: int = bentaxis.read_case("case.toml")
bentaxis.run(case, channels=3)
bentaxis.run(bentaxis.read_case("case.toml")).torque
END
export MYPYPATH=$sources/interfaces/python
check right.py
if check wrong.py > said; then echo "nothing is said of wrong types"; exit 1; fi
for line in 3 4 5; do grep -q "^wrong.py:$line: error" said || { cat said; exit 1; }; done
