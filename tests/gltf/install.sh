#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the packages of the lock file in this folder. Returns at once where they are there already.
set -euo pipefail
for program in node npm; do
  command -v "$program" >/dev/null ||
    { echo "FAULT: $program is not installed, which the tests of glTF need; run tools/setup tests" >&2; exit 1; }
done
cmp -s package-lock.json node_modules/.installed-lock.json && exit 0
# A registry may be busy for a moment.
for wait in 1 5 15; do
  if npm ci --no-audit --no-fund; then
    cp package-lock.json node_modules/.installed-lock.json
    exit 0
  fi
  sleep $wait
done
exit 1
