#!/usr/bin/env bash
# Fails if one model links the other or reaches into its folder past the include path; if what couples the models, or describes the pump for
# engines of others, knows one; if report/ computes (documents take finished results); or if a number depends on the locale. That a target
# finds no headers but those of what it links is the build's doing (scripts/cmake/BentaxisTarget.cmake).
# usage: independence_test.sh SOURCE_DIR ANALYTIC_LIBRARY[,..] MULTIBODY_LIBRARY DOCUMENTS_LIBRARY[,..] ENGINES_LIBRARY
set -euo pipefail
source_dir=$1 multibody=$3 engines=$5
IFS=, read -ra analytic <<< "$2"
IFS=, read -ra documents <<< "$4"
status=0

forbid_include() {  # folder, forbidden module
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

# Functions of the C library whose numbers depend on the locale, where a host has set one.
forbid_locale() {  # folder..
  if grep -rnE '\b(strto[df]|ato[fl]|sto[df]|[vf]?s?n?scanf) *\(|\bs?n?printf *\([^;]*%[-+ 0-9.*]*[aefgAEFG]' "$@" --include='*.h' --include='*.cpp'; then
    echo "error: numbers that depend on the locale: use number_in, number_text or fmt"
    return 1
  fi
}

forbid_include "$source_dir/analytic" multibody || status=1
forbid_include "$source_dir/multibody" analytic || status=1
for module in analytic multibody hydraulics; do
  forbid_include "$source_dir/coupled" $module || status=1
done
# What engines of others are given is written down by neither model.
for module in analytic multibody; do
  forbid_include "$source_dir/engines" $module || status=1
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

# The commands and the programs beside the module of Python run in a process of their own, which sets no locale.
forbid_locale "$source_dir"/{analytic,multibody,hydraulics,coupled,core,compare,studies,report,engines,interfaces/fmu} || status=1

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
for line in 'x = std::strtod(text, &end);' 'std::snprintf(text, 9, "%.3g", x);'; do
  echo "$line" > "$scratch/x.cpp"
  if forbid_locale "$scratch" > /dev/null; then
    echo "error: the check does not notice $line"; status=1
  fi
done
if forbid_computing_calls "$multibody" > /dev/null; then
  echo "error: the check does not notice calls that compute"; status=1
fi
if [ "$(nm -C --undefined-only "$multibody" 2>/dev/null | grep -c "bentaxis::")" = 0 ]; then
  echo "error: the check sees no symbols"; status=1
fi
[ $status = 0 ] && echo "independent"
exit $status
