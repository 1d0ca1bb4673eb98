#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# What takes too long for contrib/run_tests.sh: statistics of errors, kills at random places, faults of disks, fuzzing,
# sanitizers, films, the live page, other programs, and all numbers of the documents. Installs and builds what these need,
# runs them one after the other, and prints one table; after a break it goes on. Usage and options: contrib/verify.py.
set -euo pipefail
cd "$(dirname "$0")/.."
case " $* " in
  *" --list "* | *" --help "* | *" -h "*) ;;
  *)
    contrib/setup.sh verify
    cmake --build build --target studies
    ;;
esac
exec /usr/bin/python3 contrib/verify.py "$@"
