#!/usr/bin/env bash
# Stored curves hold with every BLAS that is installed: Simbody's solvers call it, and packages bring different ones.
#   blas_test.sh BENTAXIS REPO_ROOT [FOLDER..]     FOLDER: with further ones, instead of /usr/lib
set -euo pipefail
program=$1 root=$2
shift 2
tried=0
while IFS= read -r -d '' library; do
  folder=$(dirname "$library")
  # The reference BLAS has its LAPACK in a folder of its own; the others hold both.
  export LD_LIBRARY_PATH=$folder:$(dirname "$folder")/lapack
  used=$(ldd "$program" | sed -n 's/.*libblas\.so\.3 => \([^ ]*\).*/\1/p')
  if [[ $used != "$library" ]]; then
    echo "blas: asked for $library, got '$used'" >&2
    exit 1
  fi
  echo "blas: $used"
  said=$("$program" regress "$root/reference_data/golden") || { printf '%s\n' "$said"; exit 1; }
  tail -n 1 <<< "$said"
  tried=$((tried + 1))
done < <(find "${@:-/usr/lib}" -mindepth 3 -maxdepth 3 -name libblas.so.3 -print0 2> /dev/null)
echo "blas: $tried tried"
((tried > 0))
