#!/usr/bin/env bash
# test.sh [PART] [CTEST ARGS]: installs what is missing, builds and tests. Without a part the quick suite; or one of
#   --long      the whole suite, long tests and the trainer's among them
#   --sanitize  the quick suite under the address and undefined-behaviour sanitizers, what is labelled determinism under the thread sanitizer
#   --lint      formatting, luacheck, clang-tidy
#   --cluster   jobs on Slurm, GNU parallel and Snakemake; the Debian package; some of it needs root
#   --all       these four in turn, whatever fails, with the seconds that each took
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
jobs=$(nproc)

quick() {
  ./build.sh release --with packages-dev.txt -DPREGRASP_TESTS=ON
  exec ctest --preset release -j "$jobs" -LE 'long|trainer|cluster' "$@"
}

long() {
  ./build.sh release --with packages-dev.txt --with packages-train.txt -DPREGRASP_TESTS=ON -DPREGRASP_TRAINER=ON
  ctest --preset release -j "$jobs" -LE cluster "$@"
}

sanitize() {
  local failed=0
  # Debian's Simbody, MRPT and Mesa keep what they allocate at start-up: leaks are not looked for.
  ./build.sh asan-ubsan --with packages-dev.txt &&
    PREGRASP_FUZZ_CALLS=20000 ASAN_OPTIONS=detect_leaks=0 ctest --preset asan-ubsan -j "$jobs" -LE 'long|golden|cluster' "$@" || failed=1
  ./build.sh tsan --with packages-dev.txt --target determinism_tests && ctest --preset tsan -j "$jobs" -L determinism "$@" || failed=1
  return "$failed"
}

lint() {
  local failed=0
  # gcc's precompiled headers, which the release build has, mean nothing to clang-tidy; it reads a folder that is configured only.
  ./build.sh debug --configure-only --with packages-dev.txt --with packages-train.txt -DPREGRASP_TRAINER=ON || return 1
  tests/check_format.sh || failed=1
  luacheck --quiet scenes lua docs assets tests/ladders || failed=1
  find app render bindings -name '*.cc' -print0 | sort -z |
    xargs -0 -n 1 -P "$jobs" clang-tidy -p build/debug --quiet 2> >(grep -v ' warnings\? generated' >&2) || failed=1
  return "$failed"
}

cluster() {
  ./build.sh release --with packages-dev.txt --with packages-cluster.txt -DPREGRASP_TESTS=ON --target pregrasp
  ctest --preset release -L cluster "$@"
}

all() {
  local failed=0 part start report=
  for part in long sanitize lint cluster; do
    start=$SECONDS
    if "$0" "--$part" "$@"; then report+="$part: passed"; else report+="$part: FAILED" failed=1; fi
    report+=" in $((SECONDS - start)) s"$'\n'
  done
  printf '\n%s' "$report"
  return "$failed"
}

part=quick
case ${1:-} in
  --all | --long | --sanitize | --lint | --cluster) part=${1#--}; shift ;;
esac
"$part" "$@"
