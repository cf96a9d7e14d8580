#!/bin/sh
# Runs of the program that are killed 50 times, each at a moment that nobody chose, and go on: the checkpoint is
# whole every time, and the results are those of the runs that nobody disturbed.
#   sh kills.sh PROGRAM FOLDER MODELS      FOLDER: scratch, made and removed
set -eu
program=$1 folder=$2 models=$3 kills=0 here=0 round=0
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

fail() {
  echo "kills: $*" >&2
  exit 1
}

# What is the same in every run: all but the seconds.
result() {
  sed 's/"cpu_s":[^,}]*//' "$1"
}

# A part of a second between 0.03 and 0.13, other in every call, and longer with every kill of one run: a busy
# machine may need more to start a program and write its first checkpoint.
moment() {
  awk -v seed="$1$(date +%s)" -v kill="$2" \
    'BEGIN { srand(seed); printf "%.3f", (0.03 + 0.10 * rand()) * 1.1 ^ kill }'
}

# Start, kill after a moment, until the run is at its end.
disturbed() {
  rm -f run.ck run.ck.part
  here=0
  while :; do
    if [ -f run.ck ]; then
      "$program" resume run.ck --json --quiet > some.json 2> some.err &
    else
      "$program" solve "$@" --checkpoint run.ck --every 0.002 --json --quiet > some.json 2> some.err &
    fi
    pid=$!
    sleep "$(moment $kills $here)"
    kill -KILL $pid 2> some.kill || true # it may have come to its end
    if wait $pid; then break; fi 2> some.wait
    kills=$((kills + 1)) here=$((here + 1))
    [ ! -s some.err ] || fail "after $kills kills: $(cat some.err)"
  done
}

undisturbed() {
  "$program" solve "$@" --json --quiet > whole.json
}

while [ $kills -lt 50 ]; do
  round=$((round + 1))
  case $((round % 4)) in
  0) set -- beam radau:s=3 --rtol 1e-9 ;;
  1) set -- beam bdf --rtol 1e-7 --t1 1 --points 7 ;;
  2) set -- "$models/bounce.steif" radau:s=3 --rtol 1e-10 --events --h-max 1e-5 ;;
  3) set -- kepler verlet --h 0.000004 --t1 20 ;;
  esac
  undisturbed "$@"
  disturbed "$@"
  result some.json > a
  result whole.json > b
  cmp -s a b || fail "the result of '$*' is another after $kills kills: $(diff a b | head -c 600)"
  "$program" resume run.ck --json --quiet > some.json || fail "a finished run does not show its result"
  result some.json > a
  cmp -s a b || fail "a finished run of '$*' shows another result"
  [ $round -lt 60 ] || fail "only $kills kills in $round runs: they are too short"
done
echo "$kills kills in $round runs"
cd / && rm -rf "$folder"
