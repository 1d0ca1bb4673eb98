# SPDX-License-Identifier: LGPL-2.1-or-later
# What a user does with an installed crawler, in the present, empty folder. Ends with 0 if all of it works.
set -euxo pipefail
crawler --version
crawler init earthworm > a.prm
crawler check a.prm
crawler run a.prm
crawler plot output-a --output kymograph.png
crawler report output-a
test -s kymograph.png -a -s output-a/report.html
cat > small.prm <<'PRM'
set Accuracy = 1e-3
include a.prm
subsection Sweep
  set Axes = Body/Anchoring exponent : linspace(1.5, 3, 8)
end
PRM
mpirun -np 2 --oversubscribe crawler sweep small.prm
test "$(wc -l < output-small/results.csv)" -ge 9
crawler plot output-small
crawler run "$(find /usr/share/crawler/prm -name fig_s1.prm)" --output fig_s1
/usr/bin/python3 - <<'PYTHON'
import crawler
r = crawler.run("a.prm")
assert crawler.__file__.startswith("/usr/lib/python3"), crawler.__file__
assert r.displacement > 0 and r.displacement_error.total < 1e-5 * r.displacement, r
print(r)
PYTHON
if command -v man; then
  man crawler | grep -q 'limbless crawler'
  zcat /usr/share/doc/crawler/changelog.gz | grep -q '^crawler ('
fi
if [ -f /usr/share/bash-completion/bash_completion ]; then
  bash -c '. /usr/share/bash-completion/bash_completion; _completion_loader crawler; COMP_WORDS=(crawler swe) COMP_CWORD=1
           _crawler; test "${COMPREPLY[0]}" = sweep'
fi
