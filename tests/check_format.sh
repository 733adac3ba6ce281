#!/usr/bin/env bash
# Fails if clang-format would change a source file, and says where.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."
find app bindings render tests \( -name '*.cc' -o -name '*.h' \) -print0 | xargs -0 -n 50 -P "$(nproc)" clang-format --dry-run -Werror
