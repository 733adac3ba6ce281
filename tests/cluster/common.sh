# What the tests of engines share: a data set of 16 objects in one scene each, made in one run for comparison; and a way to
# kill tasks. To be sourced with the program as $1.
set -euo pipefail
program=$1
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
data_set=(dataset grasps --items 16 --scenes 1 --seed 7)

fail() {
  echo "FAILED: $*" >&2
  tail -n 20 "$dir"/jobs/logs/* >&2 || true
  exit 1
}

# expect WORDS FILE
expect() { grep -qF -- "$1" "$2" || fail "\"$1\" is not in $2: $(cat "$2")"; }

make_whole() {
  "$program" "${data_set[@]}" --threads "$(nproc)" --out "$dir/whole"
  "$program" dataset merge "$dir/whole" --items 16 --out "$dir/expected"
}

# The tasks, of 8, that are at an item now.
busy_tasks() {
  grep -l '"verdict": "begun"' "$dir"/jobs/made/records/*.json 2>/dev/null |
    sed 's/.*item-0*\([0-9][0-9]*\).json/\1/' | awk '{print $1 % 8 + 1}' | sort -nu
}

# kill_tasks N: kills N tasks at random, at random moments of their items; leaves their numbers in $dir/killed.
kill_tasks() {
  : >"$dir/killed"
  local tasks task
  while (($(wc -l <"$dir/killed") < $1)); do
    sleep "0.$((RANDOM % 8))"
    mapfile -t tasks < <(busy_tasks | grep -vxFf "$dir/killed")
    ((${#tasks[@]})) || continue
    task=${tasks[RANDOM % ${#tasks[@]}]}
    kill -KILL "$(pgrep -f -- "--shard $task/8 .*--out $dir/jobs/made")" 2>/dev/null || continue
    echo "$task" >>"$dir/killed"
  done
  sort -n -o "$dir/killed" "$dir/killed"
  echo "killed tasks: $(paste -sd, "$dir/killed")"
}

# The tasks that have items to make, as a list with commas.
incomplete_tasks() {
  "$program" jobs status "$dir/jobs" >/dev/null
  awk -F, 'NR > 1 && $3 != "done" {print $2}' "$dir/jobs/runs.csv" | sort -nu | paste -sd,
}

# After the kills: the killed tasks alone are incomplete, and items that were under work say how to make them alone.
check_killed() {
  [[ $(incomplete_tasks) == "$(paste -sd, "$dir/killed")" ]] || fail "incomplete: $(incomplete_tasks)"
  "$program" jobs status "$dir/jobs" >"$dir/status"
  cat "$dir/status"
  grep -q ': begun on .*--shard [0-9]*/16' "$dir/status" || fail "no item was under work"
}

check_result() { diff -r "$dir/expected" "$dir/jobs/result" || fail "other bytes than those of one run"; }
