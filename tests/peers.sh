#!/bin/sh
# peers.sh BUILD: the SUNDIALS of the installed Debian package again, from the package's source at -O2,
# in BUILD/peers: the package itself is compiled without optimisation, which flatters whom one
# compares with it.
#   tests/peers.sh build && LD_LIBRARY_PATH=build/peers/lib build/steif bench workprec
# Needs apt with network, dpkg-dev, cmake; writes in BUILD alone.
# SPDX-License-Identifier: BSD-3-Clause
set -eu
[ $# -eq 1 ] || { echo "usage: tests/peers.sh BUILD" >&2; exit 2; }
mkdir -p "$1/peers/apt/lists/partial"
cd "$1/peers"
root=$PWD

stop() { echo "peers.sh: $*" >&2; exit 1; }
for tool in apt-get dpkg-query dpkg-source cmake; do
  command -v "$tool" >/dev/null 2>&1 || stop "$tool is missing: this works on Debian and its kin"
done
version=$(dpkg-query -W -f '${source:Version}' libsundials-dev 2>/dev/null) ||
  stop "the package libsundials-dev is not installed: nothing to build again"

# apt with lists of its own: sources of this release, signed by the keys of the system.
. /etc/os-release
mirror=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/*.sources 2>/dev/null |
  sed -n 's/^URIs: *\([^ ]*\).*/\1/p; s/^deb  *\(\[[^]]*\] *\)\{0,1\}\(http[^ ]*\).*/\2/p' | head -n 1)
keys=/usr/share/keyrings/$ID-archive-keyring.gpg
echo "deb-src [signed-by=$keys] ${mirror:-http://deb.debian.org/debian} $VERSION_CODENAME main universe" \
  >apt/sources.list
[ "$ID" = ubuntu ] || sed -i 's/ universe//' apt/sources.list
get() {
  apt-get -qq -o Dir::Etc::sourcelist="$root/apt/sources.list" -o Dir::Etc::sourceparts=/dev/null \
    -o Dir::State::lists="$root/apt/lists" -o Dir::Cache="$root/apt" -o APT::Sandbox::User= "$@"
}
if [ ! -d source ]; then
  get update
  get source --download-only "sundials=$version"
  dpkg-source --no-check -x sundials_*.dsc unpacked >apt/log
  mv unpacked source
fi

# As Debian configures it, but for the flags; what steif does not use is left out.
cmake -S source -B objects -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS=-O2 -DCMAKE_INSTALL_PREFIX="$root" \
  -DCMAKE_INSTALL_LIBDIR=lib -DSUNDIALS_INDEX_SIZE=64 -DBUILD_STATIC_LIBS=OFF -DEXAMPLES_ENABLE_C=OFF \
  -DEXAMPLES_INSTALL=OFF -DENABLE_KLU=ON -DKLU_INCLUDE_DIR=/usr/include/suitesparse \
  -DKLU_LIBRARY_DIR="$(dirname "$(find /usr/lib* -name libklu.so | head -n 1)")" >apt/log 2>&1 ||
  { cat apt/log >&2; stop "configuring failed"; }
cmake --build objects -j "$(getconf _NPROCESSORS_ONLN)" >apt/log 2>&1 || { tail apt/log >&2; stop "building failed"; }
cmake --install objects >apt/log 2>&1
echo "LD_LIBRARY_PATH=$root/lib"
