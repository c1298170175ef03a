#!/bin/bash
# The batch file of contrib/cluster on this machine: cluster.sh ROOT PROGRAM OUTPUT. It is
# signalled as Slurm does before the limit, asks for the queue, and goes on where it was.
set -um
root=$1 program=$2 output=$3

fail()
{
  echo "$*" >&2
  cat "$output/said" >&2
  exit 1
}

rm -rf "$output"
mkdir -p "$output/bin"
# Stands for Slurm's own.
printf '#!/bin/bash\necho "$@" >> "%s/asked"\n' "$output" > "$output/bin/scontrol"
chmod +x "$output/bin/scontrol"
export PATH=$output/bin:$PATH SLURM_JOB_ID=7 SLURM_NTASKS=2 IMPM_DEALII=$program
job=(bash "$root/contrib/cluster/upsetting.sbatch" "$root/prm/upsetting.prm"
  -o "$output/run" --set "Grid/Adaptation/Highest level=0"
  --set "Time/Time step=1e-4" --set Output/Pictures=false)

bash -n "$root/contrib/cluster/upsetting.sbatch" || exit 1
"${job[@]}" > "$output/said" 2>&1 &
until [ "$(cat "$output/run/history.csv" 2> /dev/null | wc -l)" -ge 4 ]; do
  kill -0 $! 2> /dev/null || fail "it has ended by itself"
  sleep 0.05
done
kill -USR1 $!
wait $!
code=$?
[ $code = 138 ] || fail "exit code $code, expected 138"
[ "$(cat "$output/asked")" = "requeue 7" ] || fail "it has not asked for the queue"

# As a crash leaves it that comes right after the first checkpoint.
rm "$output/run/checkpoint/last_good"
"${job[@]}" --set "Time/End time=0.002" > "$output/said" 2>&1 || fail "exit code $?"
grep -q "restart from" "$output/said" || fail "it has not gone on"
[ "$(wc -l < "$output/asked")" = 1 ] || fail "a run that is done wants the queue"
