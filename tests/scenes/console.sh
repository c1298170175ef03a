#!/bin/bash
# What a run shows on terminals and in files: console.sh PROGRAM SCENES OUTPUT [MPIRUN].
set -u
program=$1 scenes=$2 output=$3 mpirun=${4-}

scene=("$scenes/bar_traction.prm" --output "$output/run"
  --set "Time/Largest number of steps=3" --set "Output/Pictures=false")

fail()
{
  echo "$*" >&2
  cat -v "$output/said" >&2
  exit 1
}

# Everything after the header of the steps and its note, up to their last one.
steps()
{
  grep -aE "^(not shown| +step| +[0-9]+ )" "$output/said"
}

fits()
{
  steps | awk -v n="$1" 'length($0) > n { exit 1 }' || fail "wider than $1"
  steps | grep -qE "^ +3" || fail "no steps"
}

# A file, or a pipe, has no bar.
is_plain()
{
  ! grep -q $'\r\|\033' "$output/said" || fail "has a bar"
}

rm -rf "$output"
mkdir -p "$output"
probes=(--set "Output/Probes=tip, $(seq -s ', ' -f 'p%g' 200)")
for ((i = 1; i <= 200; ++i)); do
  probes+=(--set "Output/p$i/Kind=mean" --set "Output/p$i/Field=volume")
done

unset COLUMNS
"$program" "${scene[@]}" > "$output/said" 2>&1 || fail "does not run"
is_plain
fits 80
grep -q "^impm_dealii .*bar_traction.prm" <(head -1 "$output/said") ||
  fail "does not begin with a line on what it runs"
for width in 1 20 33 80 200; do
  COLUMNS=$width "$program" "${scene[@]}" "${probes[@]}" > "$output/said" 2>&1 ||
    fail "does not run"
  is_plain
  [ "$width" = 1 ] || fits "$width"
  grep -q "^not shown" "$output/said" || [ "$width" = 1 ] || fail "no note"
done
COLUMNS=nonsense "$program" "${scene[@]}" > "$output/said" 2>&1 || fail "does not run"
fits 80

if command -v script > /dev/null; then
  for width in 5 20 60; do
    script -qec "stty cols $width; $(printf '%q ' "$program" "${scene[@]}")" \
      /dev/null > "$output/said" < /dev/null || fail "does not run on a terminal"
    tr '\r' '\n' < "$output/said" | sed 's/\x1b\[K//g' > "$output/lines"
    mv "$output/lines" "$output/said"
    [ "$width" = 5 ] || fits "$width"
    if [ "$width" = 60 ]; then
      grep -q '^\[#*\.*\] .* %' "$output/said" || fail "no bar"
    fi
    grep '^\[[#.]*\]' "$output/said" | awk -v n="$width" 'length($0) >= n { exit 1 }' ||
      fail "a bar that is too long"
  done
fi

if [ -n "$mpirun" ]; then
  "$mpirun" -np 2 "$program" "${scene[@]}" > "$output/said" 2>&1 || fail "does not run"
  is_plain
  fits 80
fi
