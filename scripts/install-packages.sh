#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Installs what building and testing need, from Debian 12 (bookworm) alone. Run it as often as you
# like: with everything there it says nothing and needs no rights.
set -eu

required="
    build-essential
    cmake
    ninja-build
    pkg-config
    libbenchmark-dev
    libboost-dev
    libcli11-dev
    libembree-dev
    libfmt-dev
    libglm-dev
    libgtest-dev
    libhwy-dev
    libimath-dev
    libkissfft-dev
    libopenexr-dev
    libopenimageio-dev
    libopenmesh-dev
    libspdlog-dev
    libtbb-dev
    libxxhash-dev
    nlohmann-json3-dev
"
# blender-data, glmark2-data: environment maps and a mesh of the demo. libsharp-dev: the transforms that the benchmark is
# held against. clang: fuzzing. fonts-dejavu-core: labels on contact sheets.
optional="
    blender-data
    clang
    fonts-dejavu-core
    glmark2-data
    libsharp-dev
"

# The packages among the arguments that are not installed.
missing() {
    for package in "$@"; do
        state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
        [ "$state" = installed ] || echo "$package"
    done
}

needed=$(missing $required)
wished=$(missing $optional)
[ -n "$needed$wished" ] || exit 0

as_root=
if [ "$(id -u)" -ne 0 ]; then as_root=sudo; fi
if ! command -v apt-get >/dev/null || ! command -v ${as_root:-true} >/dev/null; then
    [ -n "$needed" ] || exit 0
    echo "install-packages.sh: these packages are missing, and installing them takes apt-get and" \
        "root or sudo:" $needed >&2
    exit 1
fi
quiet_apt() {
    $as_root env DEBIAN_FRONTEND=noninteractive DEBCONF_NOWARNINGS=yes \
        apt-get -qq -o Dpkg::Use-Pty=0 "$@" >/dev/null
}

if [ -n "$needed" ]; then
    echo "Installing" $needed >&2
    quiet_apt update || echo "install-packages.sh: the package lists could not be renewed" >&2
    quiet_apt install -y --no-install-recommends $needed
fi
for package in $wished; do
    # Nothing is said about a package that the machine's sources do not have.
    apt-cache policy "$package" 2>/dev/null | grep -q 'Candidate: [^(]' || continue
    echo "Installing $package" >&2
    quiet_apt install -y --no-install-recommends "$package" ||
        echo "install-packages.sh: going on without $package, which is optional" >&2
done
