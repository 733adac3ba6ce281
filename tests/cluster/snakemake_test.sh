#!/usr/bin/env bash
# snakemake_test.sh PROGRAM: eight tasks by Snakemake. Three are killed, the same command again makes the rest, and what is merged
# has the bytes of one run.
source "$(dirname "$(readlink -f "$0")")/common.sh"
export XDG_CACHE_HOME=$dir/cache  # of Snakemake's own
make_whole
"$program" jobs snakemake --tasks 8 --out "$dir/jobs" -- "${data_set[@]}"
run() { snakemake --snakefile "$dir/jobs/Snakefile" --cores "$(nproc)" --keep-going; }
run >"$dir/out" 2>&1 &
engine=$!
kill_tasks 3
if wait "$engine"; then fail "killed tasks are no success"; fi
check_killed
[[ ! -e $dir/jobs/result ]] || fail "an incomplete batch was merged"
run >"$dir/out" 2>&1 || fail "$(cat "$dir/out")"
check_result
grep -E '^ *task +3' "$dir/out" || fail "not three tasks again: $(cat "$dir/out")"
