#!/usr/bin/env bash
# run.sh [ARGS]: installs what is missing, builds, and runs pregrasp ARGS; without ARGS the main job.
set -euo pipefail
root=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
"$root/build.sh" release
(($#)) || set -- run "$root/scenes/ruler.lua" --out out/ruler
exec "$root/build/release/pregrasp" "$@"
