#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh SOURCES FOLDER PROGRAMS NAME: runs test_NAME.mjs with npm's packages of FOLDER, which NAME `packages` puts there.
set -euo pipefail
sources=$1 folder=$2 programs=$3 name=$4
for program in node npm chromium; do
  command -v "$program" > /dev/null ||
    { echo "FAULT: $program is not installed, which the tests in a browser need; run tools/setup tests" >&2; exit 1; }
done

if [[ $name == packages ]]; then
  mkdir -p "$folder"
  # Sources are copied anew each time, packages only where the lock file has changed.
  rm -rf "$folder/src"
  cp -r "$sources"/tools/web/{src,index.html,build.mjs,vite.config.ts,tsconfig.json,package.json,package-lock.json,.npmrc} "$folder"
  if ! cmp -s "$folder/package-lock.json" "$folder/installed-lock.json"; then
    rm -f "$folder/installed-lock.json"
    (cd "$folder" && npm ci --ignore-scripts --no-progress)
    cp "$folder/package-lock.json" "$folder/installed-lock.json"
  fi
  exit 0
fi

# Modules are looked for beside the file that imports them.
mkdir -p "$folder/tests"
cp "$sources"/tests/web/*.mjs "$folder/tests"
KILN_SOURCES=$sources KILN_WEB=$folder KILN_PROGRAMS=$programs exec node "$folder/tests/test_$name.mjs"
