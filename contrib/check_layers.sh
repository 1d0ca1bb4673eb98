#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# A file includes only its own layer or earlier ones. Exit status 1, and the offending lines, if one does not.
set -euo pipefail
cd "$(dirname "$0")/.."
layers=(base parameters scene model rungs discretization time fused observers drivers)
bad=0
for i in "${!layers[@]}"; do
  layer=${layers[$i]}
  for later in "${layers[@]:$((i + 1))}"; do
    if grep -rn "#include <crawler/$later/" "source/$layer" "include/crawler/$layer"; then bad=1; fi
  done
done
# The time stepper knows vectors and callbacks only; the scene knows no numerics.
if grep -rn "#include <crawler/\(discretization\|scene\|model\)/" source/time include/crawler/time; then bad=1; fi
if grep -rn "#include <deal.II" source/scene include/crawler/scene source/model include/crawler/model source/rungs include/crawler/rungs 2>/dev/null; then bad=1; fi
[ "$bad" -eq 0 ] && echo "every file includes only its own layer or earlier ones" || { echo "the includes above point to a later layer" >&2; exit 1; }
