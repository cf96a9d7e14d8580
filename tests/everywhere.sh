#!/bin/sh
# everywhere.sh BUILD: the tests as on other machines. Each stage says what was run, or why it was
# skipped; the exit code is the number of stages that failed.
#   STEIF_CHECK_MINUTES   no stage begins later than this after the start (default 35)
# SPDX-License-Identifier: BSD-3-Clause
set -u
build=$(cd "${1:?the build folder of bootstrap test}" && pwd)
source=$(cd "$(dirname "$0")/.." && pwd)
minutes=${STEIF_CHECK_MINUTES:-35}
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

# stage NAME COMMAND...: its output is shown when it fails.
stage() {
  name=$1
  shift
  late "$name" && return 1
  if "$@" >"$build/check.log" 2>&1; then
    note "passed   $name"
    return 0
  fi
  tail -n 60 "$build/check.log"
  note "FAILED   $name"
  failed=$((failed + 1))
  return 1
}

# Configure and build in a folder of its own.
make() {
  folder=$1
  shift
  cmake -S "$source" -B "$folder" "$@" && cmake --build "$folder" -j "$jobs"
}
rooms() { ctest --test-dir "$1" -L room --output-on-failure -j "$jobs"; }

# Can this processor run what OpenBLAS has for that one?
runs() {
  case $1 in
    SkylakeX) set -- avx512f avx512vl ;;
    Haswell | Zen) set -- avx2 fma ;;
    *) set -- ;;
  esac
  for flag; do grep -qw "$flag" /proc/cpuinfo 2>/dev/null || return 1; done
}

for core in Haswell Zen SkylakeX Nehalem Prescott; do
  case $(uname -m) in
    x86_64) ;;
    *) note "skipped  OpenBLAS as for $core: no x86 processor"; continue ;;
  esac
  if runs $core; then
    stage "OpenBLAS as for $core" env OPENBLAS_CORETYPE=$core ctest --test-dir "$build" -L room \
      --output-on-failure -j "$jobs"
  else
    note "skipped  OpenBLAS as for $core: this processor lacks its instructions"
  fi
done

stage "build with AddressSanitizer and UBSan" make "$build/check-sanitize" -DSTEIF_SANITIZE=ON &&
  stage "tests under AddressSanitizer and UBSan" rooms "$build/check-sanitize"

if command -v mpirun >/dev/null 2>&1 && [ -n "$(find /usr/include /usr/local/include -name HYPRE.h 2>/dev/null)" ] &&
  [ -n "$(find /usr/include /usr/local/include -name dmumps_c.h 2>/dev/null)" ]; then
  stage "build of libsteif-mpi" make "$build/check-mpi" -DSTEIF_MPI=ON &&
    stage "tests over ranks" ctest --test-dir "$build/check-mpi" -L mpi --output-on-failure
else
  note "skipped  libsteif-mpi: no mpirun, hypre or MUMPS (./bootstrap tools)"
fi

reference=''
for folder in /usr/lib/*/blas /usr/lib/*/lapack /usr/lib64/blas /usr/lib64/lapack; do
  if [ -e "$folder/libblas.so.3" ] || [ -e "$folder/liblapack.so.3" ]; then
    reference="$reference${reference:+:}$folder"
  fi
done
if [ -n "$reference" ]; then
  stage "build with the reference BLAS and LAPACK" make "$build/check-reference" -DBLA_VENDOR=Generic &&
    stage "reference BLAS and LAPACK" env LD_LIBRARY_PATH="$reference" \
      ctest --test-dir "$build/check-reference" -L room --output-on-failure -j "$jobs"
else
  note "skipped  reference BLAS and LAPACK: not installed (./bootstrap tools)"
fi

if command -v clang >/dev/null 2>&1; then
  stage "build by clang, warnings are errors" make "$build/check-clang" -DCMAKE_C_COMPILER=clang \
    -DSTEIF_WERROR=ON && stage "tests built by clang" rooms "$build/check-clang"
  if stage "build of the fuzzers" make "$build/check-fuzz" -DCMAKE_C_COMPILER=clang -DSTEIF_FUZZ=ON \
    -DSTEIF_TESTS=OFF; then
    # One seed: what a change is refused for can be found again. Other seeds are for by hand.
    for target in "$source"/tests/fuzz/*.c; do
      name=$(basename "$target" .c)
      mkdir -p "$build/corpus/$name"
      stage "a minute of $name" "$build/check-fuzz/$name" -seed=1 -max_total_time=60 -timeout=120 \
        -rss_limit_mb=2048 "$build/corpus/$name" "$source/tests/fuzz/corpus/$name"
    done
  fi
else
  note "skipped  clang and the fuzzers: no clang (./bootstrap tools)"
fi

echo "check: after $(elapsed) minutes$summary"
exit $failed
