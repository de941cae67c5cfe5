#!/usr/bin/env bash
# Fails if one model links the other, or reaches into its folder past the include path, or what couples them or describes the pump for
# engines of others knows one, or if report/
# computes: documents take finished results. That a target finds
# no headers but those of what it links is the build's doing (scripts/cmake/BentaxisTarget.cmake).
# usage: independence_test.sh SOURCE_DIR ANALYTIC_LIBRARY[,..] MULTIBODY_LIBRARY DOCUMENTS_LIBRARY[,..] ENGINES_LIBRARY
set -euo pipefail
source_dir=$1 multibody=$3 engines=$5
IFS=, read -ra analytic <<< "$2"
IFS=, read -ra documents <<< "$4"
status=0

forbid_include() {  # folder, forbidden room
  if grep -rnE "#include *[\"<]([^\">]*/)?$2/" "$1" --include='*.h' --include='*.cpp'; then
    echo "error: $(basename "$1") includes $2"
    return 1
  fi
}
forbid_symbol() {  # library, forbidden namespace
  if nm -C --undefined-only "$1" 2>/dev/null | grep -E "bentaxis::$2::"; then
    echo "error: $(basename "$1") uses bentaxis::$2"
    return 1
  fi
}

# Of the models, report/ knows geometry, names and result types.
result_types='analytic/(derived|teeth|validity)|hydraulics/(power|steady_state)'
result_functions='analytic::(BevelTeeth::|derived_quantities)|multibody::(integrator_names|method_orders)'
result_functions+='|hydraulics::(effective_bulk_modulus|key_of|left_over|lines|losses|name_of|orders_of_rate|place_of|pump_power|use_of)'
forbid_computing_headers() {  # folder
  if grep -rnE '#include *"bentaxis/(analytic|multibody|hydraulics|coupled)/' "$1" --include='*.h' --include='*.cpp' |
      grep -vE "\"bentaxis/($result_types)\.h\""; then
    echo "error: $(basename "$1") includes what computes"
    return 1
  fi
}
forbid_computing_calls() {  # library; what computes in studies/ reports its progress
  if nm -C --undefined-only "$1" 2>/dev/null | sed 's/\[abi:[a-z0-9]*\]//g' |
      grep -E '^ *U bentaxis::((analytic|multibody|hydraulics|coupled)::|(study|designs)::.*(std::function<(void \(double\)|std::function<void)|::(run|prepare|plausibility)\())' |
      grep -vE "bentaxis::($result_functions)"; then
    echo "error: $(basename "$1") computes"
    return 1
  fi
}

forbid_include "$source_dir/analytic" multibody || status=1
forbid_include "$source_dir/multibody" analytic || status=1
for room in analytic multibody hydraulics; do
  forbid_include "$source_dir/coupled" $room || status=1
done
# What engines of others are given is written down by neither model.
for room in analytic multibody; do
  forbid_include "$source_dir/engines" $room || status=1
done
forbid_symbol "$engines" '(analytic|multibody)' || status=1
forbid_computing_headers "$source_dir/report" || status=1
for library in "${documents[@]}"; do
  forbid_computing_calls "$library" || status=1
done
for library in "${analytic[@]}"; do
  forbid_symbol "$library" multibody || status=1
done
forbid_symbol "$multibody" analytic || status=1

# The check itself must be able to fail.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
echo '#include "../analytic/model.h"' > "$scratch/x.cpp"
if forbid_include "$scratch" analytic > /dev/null; then
  echo "error: the check does not notice a forbidden include"; status=1
fi
echo '#include "bentaxis/analytic/model.h"' > "$scratch/x.cpp"
if forbid_computing_headers "$scratch" > /dev/null; then
  echo "error: the check does not notice a header that computes"; status=1
fi
if forbid_computing_calls "$multibody" > /dev/null; then
  echo "error: the check does not notice calls that compute"; status=1
fi
if [ "$(nm -C --undefined-only "$multibody" 2>/dev/null | grep -c "bentaxis::")" = 0 ]; then
  echo "error: the check sees no symbols"; status=1
fi
[ $status = 0 ] && echo "independent"
exit $status
