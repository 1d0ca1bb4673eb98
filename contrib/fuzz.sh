#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Fuzzes the readers of what users and disks give (tests/fuzz) with libFuzzer and the sanitizers for addresses, leaks and
# undefined behaviour, in build-fuzz/.
# An input that takes 60 s is a hang: with the sanitizers and without optimisation programs are some 30 times slower.
# Usage: contrib/fuzz.sh [SECONDS [TARGET...]]     seconds for each target (default: 60; all targets)
# What was found is in build-fuzz/findings/: once it is mended, its input goes to tests/fuzz/inputs/TARGET. Findings of
# tables, where the target goes on, are of the copies of the process that read HDF5 files first and may die of them.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-60}
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(command_line formulas parameters restart results tables)
contrib/setup.sh fuzz

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
# An input that a sanitizer stops is kept only if it aborts.
export UBSAN_OPTIONS=abort_on_error=1:print_stacktrace=1
mkdir -p build-fuzz/findings
# What parameter files and command lines may have in them.
sed -nE 's/^ *(set|subsection) ([^=]*[^ =]).*/\1 \2/p' prm/default.prm | sort -u |
  awk '{print "\"" $0 "\""} END {print "\"end\\x0a\"\n\"include \""}' >build-fuzz/parameters.dict
printf '"%s"\n' run check sweep tradeoff optimize report plot table parameters init completion man --set --output \
  --resume --overwrite --quiet --help --format --kind json prm bash robot >build-fuzz/command_line.dict
printf '"%s"\n' sin cos tan exp sqrt log abs min max sum avg sign rint pow floor ceil mod erf erfc pi L T '?' : '&&' '||' \
  '<=' '!=' >build-fuzz/formulas.dict
failed=0
for target in "${targets[@]}"; do
  folders=("$PWD/build-fuzz/corpus/$target" "$PWD/tests/fuzz/inputs/$target") # absolute: a target may go elsewhere
  [ "$target" = parameters ] && folders+=("$PWD"/prm/{examples,paper,studies,templates})
  mkdir -p "${folders[0]}"
  words=()
  [ -f "build-fuzz/$target.dict" ] && words=("-dict=build-fuzz/$target.dict")
  echo "== $target, $seconds s"
  build-fuzz/tests/fuzz/fuzz_"$target" "${folders[@]}" "${words[@]}" -max_total_time="$seconds" -timeout=60 \
    -rss_limit_mb=4096 -max_len=4096 -artifact_prefix="$PWD/build-fuzz/findings/$target-" -print_final_stats=1 \
    </dev/null >"build-fuzz/$target.log" 2>&1 || { failed=1; tail -n 40 "build-fuzz/$target.log"; }
  grep -E "stat::(number_of_executed_units|average_exec_per_sec|new_units_added)" "build-fuzz/$target.log" || true
done
exit $failed
