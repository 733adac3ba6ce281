#!/usr/bin/env bash
# test.sh [--all] [CTEST ARGS]: installs what is missing, builds and runs the tests. --all adds the long tests, the trainer's,
# the sanitizers and clang-tidy.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
all=false
if [[ ${1:-} == --all ]]; then
  all=true
  shift
fi
jobs=$(nproc)

options=(--with packages-dev.txt -DPREGRASP_TESTS=ON)
if $all; then
  options+=(--with packages-train.txt -DPREGRASP_TRAINER=ON)
fi
./build.sh release "${options[@]}"
if ! $all; then
  exec ctest --preset release -j "$jobs" -LE long "$@"
fi
ctest --preset release -j "$jobs" "$@"
./build.sh asan-ubsan --with packages-dev.txt
# Debian's Simbody, MRPT and Mesa keep what they allocate at start-up; leaks are looked for in our own code by valgrind-free means.
ASAN_OPTIONS=detect_leaks=0 ctest --preset asan-ubsan -j "$jobs" -LE 'long|golden' "$@"
./build.sh tsan --with packages-dev.txt
TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp" ctest --preset tsan -j "$jobs" -L determinism "$@"
# gcc's precompiled headers, which the release build has, mean nothing to clang-tidy; it needs a folder that is configured only.
cmake --preset debug -DPREGRASP_TRAINER=ON >/dev/null
clang-tidy -p build/debug --quiet $(git ls-files 'app/*.cc' 'render/*.cc' 'bindings/*.cc')
