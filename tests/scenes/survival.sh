#!/bin/bash
# What a run survives: survival.sh PROGRAM SCENES OUTPUT WHAT [MPIRUN].
set -um # else what is in the background ignores SIGINT
program=$1 scenes=$2 output=$3 what=$4 mpirun=$5

# The upsetting on a coarse grid, a checkpoint at every step, pictures at every
# tenth.
scene=("$scenes/upsetting.prm" --quiet --output "$output/run"
  --set "Output/Checkpoints/Interval in steps=1"
  --set "Grid/Adaptation/Highest level=0" --set "Time/Time step=1e-4")

fail()
{
  echo "$*" >&2
  [ ! -e "$output/said" ] || cat "$output/said" >&2
  exit 1
}

# Runs the scene with further arguments; the exit code must be that wanted.
run()
{
  local wanted=$1 code=0
  shift
  "$program" "${scene[@]}" "$@" > "$output/said" 2>&1 || code=$?
  [ "$code" = "$wanted" ] || fail "exit code $code, expected $wanted: $*"
}

# One line on the screen, which matches.
says()
{
  [ "$(wc -l < "$output/said")" = 1 ] && grep -Eq -- "$1" "$output/said" ||
    fail "expected one line: $1"
}

# Everything in the history but the wall time.
history_of()
{
  awk -F, -v OFS=, 'NR == 1 { for (i = 1; i <= NF; ++i)
    if ($i == "wall_seconds") wall = i }
    { $wall = ""; print }' "$1/history.csv"
}

# What the PVD files name is there and complete.
check_pictures()
{
  local pvd name
  for pvd in particles grid; do
    for name in $(sed -n 's/.*file="\([^"]*\)".*/\1/p' "$1/$pvd.pvd"); do
      tail -c 20 "$1/$name" | grep -q "</VTKFile>" || fail "$name is broken"
    done
  done
}

expect_same_history()
{
  cmp <(history_of "$output/run") <(history_of "$output/whole") ||
    fail "another history"
}

expect_same_as_whole()
{
  expect_same_history
  for pvd in particles grid; do
    cmp <(grep file= "$output/run/$pvd.pvd") \
      <(grep file= "$output/whole/$pvd.pvd") || fail "other pictures"
  done
  grep -q '"status": "done"' "$output/run/summary.json" || fail "is not done"
  check_pictures "$output/run"
}

wait_for_checkpoint()
{
  local i
  for ((i = 0; i < 200; ++i)); do
    [ ! -e "$output/run/checkpoint/last_good" ] || return
    sleep 0.05
  done
  fail "no checkpoint"
}

make_whole()
{
  run 0 --output "$output/whole"
}

rm -rf "$output"
mkdir -p "$output"
case $what in
  killed) # at any moment, twenty times
    make_whole
    RANDOM=1
    kills=0
    restart=()
    while [ "$kills" -lt 20 ]; do
      "$program" "${scene[@]}" "${restart[@]}" > "$output/said" 2>&1 &
      pid=$!
      sleep "$(printf '0.%03d' $((150 + RANDOM % 400)))"
      kill -KILL "$pid" 2> /dev/null && kills=$((kills + 1))
      wait "$pid" 2> /dev/null
      [ ! -e "$output/run/particles.pvd" ] || check_pictures "$output/run"
      restart=()
      if [ -e "$output/run/checkpoint/last_good" ]; then
        restart=(--restart)
      fi
    done
    run 0 "${restart[@]}"
    expect_same_as_whole
    ;;
  signal)
    make_whole
    for signal in INT:130 TERM:143 USR1:138; do
      rm -rf "$output/run"
      "$program" "${scene[@]}" > "$output/said" 2>&1 &
      pid=$!
      wait_for_checkpoint
      kill "-${signal%:*}" "$pid"
      wait "$pid"
      code=$?
      [ "$code" = "${signal#*:}" ] || fail "exit code $code"
      says "^impm_dealii: stopped by signal .* step [0-9]+.* to go on: .*upsetting.prm .*--output .*--restart"
      grep -q '"status": "stopped by a signal"' "$output/run/summary.json" ||
        fail "no status"
      check_pictures "$output/run"
      run 0 --restart
      expect_same_as_whole
    done
    ;;
  ranks) # a signal to mpirun, and one of its processes killed
    ranks=("$mpirun" -np 2 "$program" "${scene[@]}")
    "${ranks[@]}" --output "$output/whole" > "$output/said" 2>&1 ||
      fail "does not run"
    "${ranks[@]}" > "$output/said" 2>&1 &
    pid=$!
    wait_for_checkpoint
    kill -USR1 "$pid"
    wait "$pid" # with what mpirun makes of two codes
    grep -q "stopped by signal .* step [0-9]+.* to go on: .*upsetting.prm .*--output .*--restart" -E \
      "$output/said" || fail "does not stop"
    check_pictures "$output/run"
    "${ranks[@]}" --restart > "$output/said" 2>&1 &
    pid=$!
    sleep 0.5
    pkill -KILL -n -f "$output/run --set" || fail "nobody to kill"
    wait "$pid" && fail "goes on without a process"
    check_pictures "$output/run"
    "${ranks[@]}" --restart > "$output/said" 2>&1 || fail "does not restart"
    expect_same_as_whole
    ;;
  damaged)
    make_whole
    for damage in "rm grid" "truncate -s 0 json" "truncate -s -100 state" \
      "dd if=/dev/zero bs=1 count=8 seek=99 conv=notrunc status=none \
        of= grid_variable.data"; do
      run 0 --set "Time/Largest number of steps=15"
      last=$(cat "$output/run/checkpoint/last_good")
      damaged=$output/run/checkpoint/$last.${damage##* }
      command=${damage% *}
      case $command in
        *of=) $command"$damaged" ;;
        *) $command "$damaged" ;;
      esac
      run 0 --restart --verbose --set "Time/Largest number of steps=16"
      grep -q "warning: $damaged is missing or damaged; the one before" \
        "$output/said" || fail "does not say: $damage"
    done
    run 0 --restart
    expect_same_history
    rm "$output"/run/checkpoint/[ab].json
    run 1 --restart
    says "no checkpoint to restart from in '.*run': .*json is missing or damaged"
    ;;
  changed)
    run 1 --restart
    says "there is no directory '.*run'"
    [ ! -e "$output/run" ] || fail "writes"
    mkdir "$output/run"
    run 1 --restart
    says "no checkpoint to restart from"
    run 0 --set "Time/End time=1e-3"
    run 1 --restart --set "Materials/steel/Yield stress=0.8e9"
    says "'Materials/steel/Yield stress': found '0.8e9', .*has, '0.7e9'"
    run 1 --restart --set "Time/Transfer=APIC"
    says "'Time/Transfer': found 'APIC'.*'FLIP'"
    # What may change.
    run 0 --restart --set "Time/End time=2e-3" --set "Time/Time step=5e-5" \
      --set "Solver/Newton tolerance=1e-9" --set "Output/Pictures=false" \
      --set "Output/Point fields=displacement"
    # Gauss points do not know where they began unless a reference asks for it.
    scene=("$scenes/extreme/footing_finite_elements.prm" --quiet
      --output "$output/run" --set "Output/Checkpoints/Interval in steps=1"
      --set "Time/Largest number of steps=1")
    run 0
    run 0 --restart --set "Output/Point fields=displacement" \
      --set "Time/Largest number of steps=2"
    run 1 --restart --set "Reference/Names=pressure, still" \
      --set "Reference/still/Field=displacement" \
      --set "Reference/still/Expression=0; 0"
    says "do not have 'initial_position'"
    ;;
  locked)
    "$program" "${scene[@]}" > /dev/null 2>&1 &
    pid=$!
    for ((i = 0; i < 200; ++i)); do
      [ ! -e "$output/run/parameters.prm" ] || break
      sleep 0.05
    done
    kill -STOP "$pid"
    run 1
    says "another run writes into the directory"
    run 1 --restart
    says "another run writes into the directory"
    kill -CONT "$pid"
    # wait may report the stop, since there is job control.
    for ((i = 0; i < 1200; ++i)); do
      ! grep -q '"status": "done"' "$output/run/summary.json" 2> /dev/null ||
        break
      sleep 0.05
    done
    [ "$i" -lt 1200 ] || fail "is disturbed"
    wait "$pid" || true
    ;;
  anew) # A new run removes what is its own, and nothing else.
    run 0 --set "Time/End time=2e-3"
    [ -e "$output/run/particles_00002.vtu" ] || fail "no picture"
    touch "$output/run/"{notes.txt,particles.py,grid_1.vtu,checkpoint/c.grid}
    run 0 --set "Time/End time=1e-4"
    [ ! -e "$output/run/particles_00002.vtu" ] || fail "keeps old pictures"
    for file in notes.txt particles.py grid_1.vtu checkpoint/c.grid; do
      [ -e "$output/run/$file" ] || fail "removes $file"
    done
    ;;
  unwritable) # each file in turn: one line with its name
    run 0 --set "Time/Largest number of steps=1"
    cp -a "$output/run" "$output/start"
    for file in summary.json parameters.prm particles.pvd grid.pvd \
      checkpoint/last_good; do
      ln -s /dev/full "$output/run/$file.new"
      run 3 --set "Time/Largest number of steps=2"
      says "^impm_dealii: system failure: cannot write '.*run/$file'"
      rm -f "$output/run/$file.new"
    done
    for file in particles_00002.vtu grid_00002.vtu; do
      rm -rf "$output/run"
      cp -a "$output/start" "$output/run"
      ln -s /dev/full "$output/run/$file"
      run 3 --restart --set "Output/Steps between pictures=2" \
        --set "Time/Largest number of steps=2"
      says "^impm_dealii: system failure: cannot write '.*run/$file'"
    done
    mkdir "$output/run/history.csv.d" # no file, but a directory
    rm "$output/run/history.csv"
    mv "$output/run/history.csv.d" "$output/run/history.csv"
    run 3 --restart
    says "^impm_dealii: system failure: .*run/history.csv"
    ;;
  gone) # the directory, while the run is on; p4est ends a program that it
    # finds without one while it saves a grid
    "$program" "${scene[@]}" --set "Output/Checkpoints/Interval in steps=0" \
      > "$output/said" 2>&1 &
    pid=$!
    for ((i = 0; i < 200; ++i)); do
      [ "$(wc -l < "$output/run/history.csv" 2> /dev/null || echo 0)" -lt 3 ] || break
      sleep 0.05
    done
    mv "$output/run" "$output/elsewhere"
    wait "$pid"
    code=$?
    [ "$code" = 3 ] || fail "exit code $code"
    says "^impm_dealii: system failure: .*run/.*"
    [ ! -e "$output/run" ] || fail "makes it anew"
    ;;
  study) # stopped by a signal, and gone on with
    scene=("$scenes/upsetting.prm" --output "$output/run" --study
      --set "Grid/Adaptation/Highest level=0" --set "Study/Lists=step"
      --set "Study/step/Entries=Time/Time step"
      --set "Study/step/Values=1e-3 | 2e-5 | 5e-4")
    "$program" "${scene[@]}" > "$output/said" 2>&1 &
    pid=$!
    for ((i = 0; i < 400; ++i)); do
      [ "$(wc -l < "$output/run/2e-5/history.csv" 2> /dev/null || echo 0)" -lt 3 ] || break
      sleep 0.05
    done
    kill -TERM "$pid"
    wait "$pid"
    code=$?
    [ "$code" = 143 ] || fail "exit code $code"
    grep -Eq "^impm_dealii: stopped by signal 15 in run '2e-5', 1 of 3 are done; to go on: .*upsetting.prm .*--study" \
      "$output/said" || fail "does not say how to go on"
    grep -q '"status": "stopped by a signal"' "$output/run/2e-5/summary.json" ||
      fail "the run is not told"
    [ "$(wc -l < "$output/run/study.csv")" = 2 ] || fail "another table"
    grep -q '"runs": 3' "$output/run/study.json" || fail "no number of runs"
    "$program" "${scene[@]}" --set "Study/step/Values=1e-3 | 5e-4" \
      > "$output/said" 2>&1 || fail "does not go on"
    grep -q "1/2 1e-3: kept, done" "$output/said" || fail "keeps nothing"
    [ "$(wc -l < "$output/run/study.csv")" = 3 ] || fail "lacks a run"
    ;;
  full) # disk; needs the rights of root to make one
    mkdir "$output/run"
    mount -t tmpfs -o size=2m tmpfs "$output/run" 2> /dev/null ||
      { echo "cannot mount a tmpfs: left out"; exit 77; }
    trap 'umount "$output/run"' EXIT
    scene+=(--set "Time/End time=4e-3")
    make_whole
    for pictures in true false hdf5; do
      format=()
      if [ "$pictures" = hdf5 ]; then
        format=(--set Output/Format=hdf5)
        pictures=true
      fi
      # Sooner or later there is no room for pictures or checkpoints.
      for kilobytes in 1200 1600; do
        rm -rf "$output/run/"*
        run 0 --set "Time/Largest number of steps=3"
        head -c "$((kilobytes * 1024))" /dev/zero > "$output/run/filler"
        code=0
        "$program" "${scene[@]}" --restart --set "Output/Pictures=$pictures" \
          "${format[@]}" --set "Output/Steps between pictures=1" > "$output/said" 2>&1 || code=$?
        case $code in
          0) ;;
          3) says "^impm_dealii: system failure: cannot write '.*run/.*'" ;;
          *) fail "exit code $code" ;;
        esac
        cat "$output/said"
        check_pictures "$output/run"
        awk -F, 'NR == 1 { n = NF } NF != n { exit 1 }' \
          "$output/run/history.csv" || fail "half a row"
        rm "$output/run/filler"
        run 0 --restart
        expect_same_history
      done
    done
    ;;
esac
