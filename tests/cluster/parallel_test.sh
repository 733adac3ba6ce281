#!/usr/bin/env bash
# parallel_test.sh PROGRAM: eight tasks by GNU parallel. Three are killed, the same script again makes the rest, and what is merged
# has the bytes of one run.
source "$(dirname "$(readlink -f "$0")")/common.sh"
make_whole
"$program" jobs parallel --tasks 8 --out "$dir/jobs" -- "${data_set[@]}"
"$dir/jobs/run.sh" >"$dir/out" 2>&1 &
engine=$!
kill_tasks 3
if wait "$engine"; then fail "killed tasks are no success"; fi
cat "$dir/out"
check_killed
[[ ! -e $dir/jobs/result ]] || fail "an incomplete batch was merged"
"$dir/jobs/run.sh"
check_result
again=$(awk 'NR > 9 {print $NF}' "$dir/jobs/joblog-8.tsv" | sort -n | paste -sd,)
[[ $again == "$(paste -sd, "$dir/killed")" ]] || fail "run again: $again"
