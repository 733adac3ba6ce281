#!/usr/bin/env bash
# run.sh [ARGS]: installs what is missing, builds, and runs pregrasp ARGS; without ARGS the first example.
set -euo pipefail
root=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
"$root/build.sh" release
(($#)) || set -- script "$root/lua/examples/push.lua"
exec "$root/build/release/pregrasp" "$@"
