#!/bin/sh
# Rows reach --csv, and the terminal, as they come: runs of several verbs that would take minutes are killed as soon
# as some rows are in the file; these are whole, and are those of the terminal. SIGTERM keeps them as well.
#   sh rows.sh PROGRAM FOLDER      FOLDER: scratch, made and removed
set -eu
program=$1 folder=$2
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

fail() {
  echo "rows: $*" >&2
  exit 1
}

# Lines of a file, 0 where there is none.
lines() {
  if [ -f "$1" ]; then wc -l < "$1"; else echo 0; fi
}

# disturbed SIGNAL EXIT FILE WORDS...: a run that is sent the signal when FILE has three lines.
disturbed() {
  signal=$1 wanted=$2 file=$3 code=0 waited=0
  shift 3
  rm -f "$file" out err
  "$program" "$@" > out 2> err &
  pid=$!
  while [ "$(lines "$file")" -lt 3 ]; do
    kill -0 $pid 2> some.kill || fail "'$*' ended before its rows came: $(cat err)"
    waited=$((waited + 1))
    [ $waited -lt 1200 ] || fail "'$*': no rows in $file after a minute"
    sleep 0.05
  done
  kill -"$signal" $pid || fail "'$*' had ended: nothing is shown by it"
  wait $pid 2> some.wait || code=$?
  [ $code = "$wanted" ] || fail "'$*' after SIG$signal: exit $code, not $wanted: $(cat err)"
  awk -F, 'NR == 1 { n = NF } NF != n { exit 1 } END { exit NR < 3 }' "$file" ||
    fail "'$*' after SIG$signal: rows of $file are cut: $(head -c 300 "$file")"
}

# The second cell of the first row is on the terminal as well, to four digits.
on_terminal() {
  cell=$(sed -n 2p "$1" | cut -d, -f1)
  awk -v cell="$cell" '{ d = $1 - cell; if (NF > 1 && $1 ~ /^[0-9.]/ && d * d <= 1e-8 * cell * cell) found = 1 }
                       END { exit !found }' out || fail "no row of $1 on the terminal: $(head -c 600 out)"
}

for signal in "KILL 137" "TERM 143"; do
  set -- $signal
  disturbed $1 $2 a.csv order be --halvings 30 --csv a.csv
  on_terminal a.csv
  disturbed $1 $2 a.csv energy kepler verlet --h 1e-4 --t1 9e4 --rows 1000000 --csv a.csv
  on_terminal a.csv
  disturbed $1 $2 a.csv sensitivity rober radau:s=3 --t1 9e6 --h 0.01 --points 100000 --csv a.csv
  on_terminal a.csv
  disturbed $1 $2 a.csv supervise steyer bdf:p=2 --rtol 1e-5 --rate 0.035 --window 0.5 --t1 3000 --csv a.csv
  on_terminal a.csv
  disturbed $1 $2 a.csv compare kepler radau:s=3 radau:s=3 --hs 0.5,0.25,0.125,1e-8 --csv a.csv
  disturbed $1 $2 a.csv impulse switchrlc --method radau:s=7 --h 1e-10 --t1 0.1 --csv a.csv
done
# Of a benchmark, which says so after SIGTERM.
disturbed KILL 137 a.csv bench success --problems vdpol --longest 0.1 --rtols 1e-9 --csv a.csv
disturbed TERM 143 a.csv bench success --problems vdpol --longest 0.1 --rtols 1e-9 --csv a.csv
grep -q "STEIF_STOPPED" err || fail "bench does not say that it was interrupted: $(cat err)"
# Every row of a sweep.
disturbed KILL 137 a.csv sweep rober be --h 1e-4 --p k1=0.01:0.07:100000 --t1 40 --csv a.csv
# Of one solution: after the exponents, which take a part of the time.
disturbed KILL 137 b.csv lyapunov aliased bdf:p=2 --h 0.001 --t1 400 --series b.csv
cd / && rm -rf "$folder"
