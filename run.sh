#!/usr/bin/env bash
# run.sh [ARGS]: installs what is missing, builds, and runs pregrasp ARGS.
set -euo pipefail
root=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
"$root/build.sh" release
exec "$root/build/release/pregrasp" "$@"
