#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Tests what CI is told of a build: the canary misses its budget, and exit status, JUnit XML (read by a parser that is
# not ours) and Markdown say so; comparisons with a baseline. Usage: test_gate.sh PROGRAMS SOURCE PYTHON
set -eu
kiln=$1/kiln source=$2 python=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "FAILED: $*" >&2; exit 1; }
expect() { # STATUS COMMAND...
  wanted=$1 status=0
  shift
  "$@" >printed 2>said || status=$?
  [ $status -eq "$wanted" ] || fail "exit status $status of $*: $(cat said)"
}
# Reads junit.xml: prints "tests failures", then each failure's text.
junit() {
  "$python" - "$1" <<'EOF'
import sys
from junitparser import Failure, JUnitXml
xml = JUnitXml.fromfile(sys.argv[1])
cases = [case for suite in xml for case in suite]
failures = [result for case in cases for result in case.result if isinstance(result, Failure)]
assert xml.tests == len(cases) and xml.failures == len(failures), (xml.tests, xml.failures)
print(len(cases), len(failures))
for failure in failures: print(failure.message)
EOF
}

# The canary.
mkdir samples
sed "s/report: {/report: {error-samples: 64, cameras: 1, /" "$source/samples/canary.yaml" >samples/canary.yaml
expect 4 "$kiln" build samples/canary.yaml
junit out/canary/junit.xml >cases
head -1 cases | grep -qx "3 1" || fail "cases of the canary: $(cat cases)"
grep -q "now 0.*, at most 0.0001" cases || fail "the failure does not say what it is: $(cat cases)"
grep -q "canary | simplify.hausdorff" out/canary/summary.md || fail "Markdown: $(cat out/canary/summary.md)"

# Compared with itself, it still misses the budget, and nothing changed.
cp -r out/canary baseline
expect 4 "$kiln" report samples/canary.yaml --baseline baseline --json
"$python" - printed "$source/docs/schema/comparison.schema.json" <<'EOF'
import json, sys, jsonschema
comparison = json.load(open(sys.argv[1]))
jsonschema.validate(comparison, json.load(open(sys.argv[2])))
asset, = comparison["assets"]
assert {change["verdict"] for change in asset["changes"]} == {"same"}, asset["changes"]
assert asset["picture"]["largest"] == 0 and comparison["failures"] == 1
EOF
junit out/canary/junit.xml | grep -q "was 0.*, now 0.*, at most 0.0001" || fail "JUnit XML without the baseline's value"

# Without budgets all is well, and the summary is empty.
sed -i '/budgets:/,$d' samples/canary.yaml
expect 0 "$kiln" build samples/canary.yaml
[ ! -s out/canary/summary.md ] || fail "a summary where all is well"
expect 0 "$kiln" report samples/canary.yaml --baseline baseline
[ -e out/canary/comparison.html ] || fail "no page"

# A coarser mesh is worse, and says so; it fails nothing, for no budget says that it may not.
sed -i 's/faces: 200/faces: 100/' samples/canary.yaml
expect 0 "$kiln" build samples/canary.yaml
expect 0 "$kiln" report samples/canary.yaml --baseline baseline
grep -q "### Worse" out/canary/summary.md && grep -q simplify.hausdorff out/canary/summary.md || fail "$(cat out/canary/summary.md)"

# An empty comparison, a missing picture, and an asset that was not built are failures.
mkdir empty
expect 4 "$kiln" report samples/canary.yaml --baseline empty
grep -q "nothing was compared" said || fail "$(cat said)"
junit out/canary/junit.xml | grep -q "nothing was compared" || fail "JUnit XML of an empty comparison"
rm baseline/canary/report.png
expect 4 "$kiln" report samples/canary.yaml --baseline baseline
junit out/canary/junit.xml | grep -q "baseline has no picture" || fail "JUnit XML of a missing picture"
rm out/canary/canary/metrics.json
expect 4 "$kiln" report samples/canary.yaml
junit out/canary/junit.xml | grep -q "has no report" || fail "JUnit XML of an asset that was not built"
expect 3 "$kiln" report samples/canary.yaml --baseline nowhere

# A stage that fails is a failure, whatever an earlier build has left.
printf 'v 0 0 0\nf 1 1 1\n' >broken.obj
sed -i 's|mesh: .*|mesh: ../broken.obj|' samples/canary.yaml
expect 3 "$kiln" build samples/canary.yaml
junit out/canary/junit.xml | grep -q "simplify failed with exit status 3" || fail "JUnit XML of a failed stage"
