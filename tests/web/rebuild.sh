#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# rebuild.sh [FOLDER]: makes tools/web/dist anew from its sources, with npm's packages in FOLDER (build/release/web).
set -euo pipefail
sources=$(cd "$(dirname "$0")/../.." && pwd)
folder=${1:-$sources/build/release/web}
"$sources/tests/web/run.sh" "$sources" "$folder" "" packages
rm -rf "$sources/tools/web/dist"
node "$folder/build.mjs" "$sources/tools/web/dist"
