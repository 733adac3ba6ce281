#!/usr/bin/env bash
# config_test.sh SOURCE BUILD: a program of others finds the installed library and everything that its targets link.
set -euo pipefail
source_folder=$1 build=$2
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cmake --install "$build" --component development --prefix "$dir/installed" >"$dir/log" || { cat "$dir/log"; exit 1; }
cmake -S "$source_folder/tests/package/consumer" -B "$dir/built" -G Ninja -DCMAKE_PREFIX_PATH="$dir/installed"
