#!/bin/sh
# everywhere.sh BUILD: the tests as on other machines. Each stage says what was run, or why it was
# skipped; the exit code is the number of stages that failed.
#   STEIF_CHECK_MINUTES   no stage begins later than this after the start (default 36)
# SPDX-License-Identifier: BSD-3-Clause
set -u
build=$(cd "${1:?the build folder of bootstrap test}" && pwd)
source=$(cd "$(dirname "$0")/.." && pwd)
minutes=${STEIF_CHECK_MINUTES:-36}
jobs=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
begun=$(date +%s)
failed=0
summary=''
export OPENBLAS_NUM_THREADS=1

elapsed() { echo $((($(date +%s) - begun) / 60)); }
note() {
  summary="$summary
  $(elapsed) min  $*"
  echo "check: $*"
}
late() {
  [ "$(elapsed)" -lt "$minutes" ] && return 1
  note "skipped  $1: $minutes minutes have passed"
}

# told NAME CODE LOG: what a stage came to; its output is shown when it failed.
told() {
  if [ "$2" -eq 0 ]; then
    note "passed   $1"
    return 0
  fi
  tail -n 60 "$3"
  note "FAILED   $1"
  failed=$((failed + 1))
  return 1
}

# stage NAME COMMAND...
stage() {
  name=$1
  shift
  late "$name" && return 1
  code=0
  "$@" >"$build/check.log" 2>&1 || code=$?
  told "$name" $code "$build/check.log"
}

# made FOLDER TARGETS OPTIONS...: configured and built in a folder of its own.
made() {
  folder=$1
  targets=$2
  shift 2
  cmake -S "$source" -B "$folder" "$@" && cmake --build "$folder" -j "$jobs" --target $targets
}
rooms_and_more() {
  echo "^($(ctest --test-dir "$build" -N -L room | sed -n 's/.*Test *#[0-9]*: //p' | tr '\n' '|')manual|ranks_runs_.*)$"
}
rooms() { ctest --test-dir "$1" -L room --output-on-failure -j "$jobs"; }

# A minute of every fuzzer, as many at a time as there are processors: each runs on one.
# One seed: what a change is refused for can be found again. Other seeds are for by hand.
fuzz() {
  mkdir -p "$build/corpus/$1"
  "$sanitized/$1" -seed=1 -max_total_time=60 -timeout=120 -rss_limit_mb=2048 "$build/corpus/$1" \
    "$source/tests/fuzz/corpus/$1" >"$build/check-$1.log" 2>&1
  echo $? >"$build/check-$1.code"
}
fuzz_together() {
  for one; do fuzz "$one" & done
  wait
  for one; do told "a minute of $one" "$(cat "$build/check-$one.code")" "$build/check-$one.log"; done
}
fuzz_all() {
  set --
  for target in "$source"/tests/fuzz/*.c; do
    one=$(basename "$target" .c)
    late "a minute of $one" && continue
    set -- "$@" "$one"
    [ $# -lt "$jobs" ] || { fuzz_together "$@"; set --; }
  done
  fuzz_together "$@"
}

# Can this processor run what OpenBLAS has for that one?
runs() {
  case $1 in
    SkylakeX) set -- avx512f avx512vl ;;
    Haswell | Zen) set -- avx2 fma ;;
    *) set -- ;;
  esac
  for flag; do grep -qw "$flag" /proc/cpuinfo 2>/dev/null || return 1; done
}

# Only what the stage runs is built; the sanitizers at -O1, which compiles sooner.
if stage "build with AddressSanitizer and UBSan" made "$build/check-sanitize" rooms -DSTEIF_SANITIZE=ON \
  -DCMAKE_C_FLAGS_RELEASE="-O1 -g1"; then
  stage "tests under AddressSanitizer and UBSan" rooms "$build/check-sanitize"
fi

sanitized=$build/check-fuzz
if command -v clang >/dev/null 2>&1; then
  if stage "build of the fuzzers by clang" made "$sanitized" fuzzers -DCMAKE_C_COMPILER=clang -DSTEIF_FUZZ=ON \
    -DSTEIF_TESTS=OFF; then
    fuzz_all
  fi
  stage "build by clang, warnings are errors" made "$build/check-clang" all -DCMAKE_C_COMPILER=clang \
    -DSTEIF_WERROR=ON && stage "tests built by clang" rooms "$build/check-clang"
else
  note "skipped  clang and the fuzzers: no clang (./bootstrap tools)"
fi

reference=''
for folder in /usr/lib/*/blas /usr/lib/*/lapack /usr/lib64/blas /usr/lib64/lapack; do
  if [ -e "$folder/libblas.so.3" ] || [ -e "$folder/liblapack.so.3" ]; then
    reference="$reference${reference:+:}$folder"
  fi
done
if [ -n "$reference" ]; then
  # Rounding of one more processor, without another build: the reference LAPACK over a BLAS that adds in another order.
  ahead=$build/check-orders.so
  for folder in $(echo "$reference" | tr ':' ' '); do
    for file in "$folder/liblapack.so.3" "$folder/libblas.so.3"; do [ -e "$file" ] && ahead="$ahead $file"; done
  done
  stage "build of a BLAS with other orders of summation" ${CC:-cc} -std=gnu11 -O2 -ffp-contract=off -Wall -Wextra \
    -shared -fPIC "$source/tests/everywhere/orders.c" -o "$build/check-orders.so" -lm &&
    stage "other orders of summation, ranks and manual, too" env STEIF_BLAS_ORDER=3 LD_PRELOAD="$ahead" \
      ctest --test-dir "$build" -R "$(rooms_and_more)" --output-on-failure -j "$jobs"
  stage "build with the reference BLAS and LAPACK" made "$build/check-reference" rooms -DBLA_VENDOR=Generic &&
    stage "reference BLAS and LAPACK" env LD_LIBRARY_PATH="$reference" \
      ctest --test-dir "$build/check-reference" -L room --output-on-failure -j "$jobs"
else
  note "skipped  reference BLAS and LAPACK: not installed (./bootstrap tools)"
fi

# What bootstrap made since ./bootstrap tools: there libsteif-mpi is built where all of it is found.
if [ -e "$build/test_ranks" ]; then
  stage "tests over ranks" ctest --test-dir "$build" -L mpi --output-on-failure -j "$jobs"
else
  note "skipped  libsteif-mpi: no MPI, hypre or MUMPS (./bootstrap tools)"
fi

for core in Haswell Zen SkylakeX Nehalem Prescott; do
  case $(uname -m) in
    x86_64) ;;
    *) note "skipped  OpenBLAS as for $core: no x86 processor"; continue ;;
  esac
  label="OpenBLAS as for $core" rooms=.
  if [ $core = Zen ]; then # its kernels are Haswell's, with other sizes of blocks
    label="$label, the modules that call it most" rooms='^(pencil|matfun|impulse|runs|discrete|method)$'
  fi
  if runs $core; then
    stage "$label" env OPENBLAS_CORETYPE=$core ctest --test-dir "$build" -L room -R "$rooms" \
      --output-on-failure -j "$jobs"
  else
    note "skipped  OpenBLAS as for $core: this processor lacks its instructions"
  fi
done

echo "check: after $(elapsed) minutes$summary"
exit $failed
