#!/usr/bin/env bash
# slurm_test.sh PROGRAM: an array of eight tasks on a Slurm of one node. Three are killed, the rest is submitted again, and what is
# merged has the bytes of one run. As root.
if ((EUID != 0)); then
  echo "a Slurm without systemd needs root"
  exit 77  # skipped
fi
here=$(dirname "$(readlink -f "$0")")
source "$here/common.sh"
mkdir "$dir/node"
trap '"$here/slurm_node.sh" stop "$dir/node"; sleep 1; rm -rf "$dir"' EXIT
"$here/slurm_node.sh" start "$dir/node" 5  # indices to 4: eight tasks are two windows
export SLURM_CONF=$dir/node/slurm.conf

wait_for_queue() {
  while [[ -n $(squeue -h) ]]; do sleep 0.5; done
}

make_whole
"$program" jobs slurm --tasks 8 --out "$dir/jobs" --dry-run -- "${data_set[@]}" >"$dir/dry"
expect "task 8: 2 items, 0 of them made: " "$dir/dry"
[[ ! -e $dir/jobs ]] || fail "a dry run wrote something"
"$program" jobs slurm --tasks 8 --out "$dir/jobs" -- "${data_set[@]}"
grep '#SBATCH' "$dir/jobs/task.sbatch"
grep -q '#SBATCH --mem=[1-9][0-9]*00M' "$dir/jobs/task.sbatch" || fail "no memory of a measured item is asked"
[[ $(ls "$dir/jobs/made" | grep -c '^item-') == 1 ]] || fail "one item was measured"

"$dir/jobs/submit.sh" >"$dir/submitted"
cat "$dir/submitted"
expect "array 1-4 from task 1: " "$dir/submitted"
expect "array 1-4 from task 5: " "$dir/submitted"
kill_tasks 3
wait_for_queue
check_killed
expect "got none" "$dir/jobs/logs/merge.txt"
[[ ! -e $dir/jobs/result ]] || fail "an incomplete batch was merged"

expected=$("$program" jobs status "$dir/jobs" --incomplete --max-array 5 | awk '{print "array " $2 " from task " $1 + 1}')
"$dir/jobs/submit.sh" >"$dir/submitted"
[[ $(grep '^array' "$dir/submitted" | sed 's/: job.*//') == "$expected" ]] || fail "submitted again: $(cat "$dir/submitted")"
wait_for_queue
check_result

# One index, by hand; other items are left alone.
rm "$dir/jobs/made/item-000002.safetensors" "$dir/jobs/made/item-000010.safetensors"
touch "$dir/before"
sbatch --wait --array=3 "$dir/jobs/task.sbatch"
made=$(find "$dir/jobs/made" -name 'item-*.safetensors' -newer "$dir/before" -printf '%f\n' | sort | paste -sd' ')
[[ $made == "item-000002.safetensors item-000010.safetensors" ]] || fail "index 3 made $made"
"$dir/jobs/merge.sh"
check_result

# Another build: its items are refused among these, and in a merge with them.
cp "$program" "$dir/other"
echo >>"$dir/other"
export PREGRASP_DATA
PREGRASP_DATA=$("$program" info | awk '$1 == "data" {print $2}')
if "$dir/other" "${data_set[@]}" --shard 8/8 --out "$dir/jobs/made" 2>"$dir/refused"; then fail "items of two builds in a folder"; fi
expect "program: " "$dir/refused"
"$dir/other" "${data_set[@]}" --shard 8/8 --out "$dir/others"
if "$program" dataset merge "$dir/jobs/made" "$dir/others" --items 16 --out "$dir/mixed" 2>"$dir/refused"; then
  fail "items of two builds were merged"
fi
expect "program: " "$dir/refused"

# A study of eval by its name, indices from 0.
"$program" jobs slurm ik-order --tasks 2 --first-index 0 --out "$dir/study" -- --seeds 4
"$dir/study/submit.sh"
wait_for_queue
"$program" eval --study ik-order --seeds 4 --out "$dir/study-whole" >/dev/null
without_seconds() { sed '/"seconds"/d' "$1/ik-order.json"; }
diff <(without_seconds "$dir/study-whole") <(without_seconds "$dir/study/result") || fail "another table"
