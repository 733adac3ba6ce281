#!/usr/bin/env bash
# tests/bench/run.sh NAME [BENCHMARK ARGS]: builds benchmark NAME and its peers, runs it, writes build/bench/NAME.json.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.."
name=${1:?usage: tests/bench/run.sh NAME [BENCHMARK ARGS], NAME one of $(ls tests/bench/*_bench.cc | xargs -n1 basename -s .cc | xargs)}
shift
[[ -f tests/bench/$name.cc ]] || { echo "tests/bench: expected a benchmark's name, got \"$name\"" >&2; exit 2; }
./build.sh release --with packages-dev.txt -DPREGRASP_BENCH=ON
mkdir -p build/bench
exec "build/release/$name" --benchmark_out="build/bench/$name.json" --benchmark_out_format=json "$@"
