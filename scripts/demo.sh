#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Installs, builds, and fogs a real environment map: out/demo gets three EXRs and a contact sheet.
set -eu
cd "$(dirname "$0")/.."

scripts/install-packages.sh
scripts/build.sh airlight_cli

map=/usr/share/blender/datafiles/studiolights/world/interior.exr
if [ ! -r "$map" ]; then
    map=data/lamps.exr
    echo "Debian's blender-data is not there, so the demo takes $map."
fi
mkdir -p out/demo
for thickness in 0.5 1 2; do
    build/release/airlight fog "$map" "out/demo/$(basename "$map" .exr)-T$thickness.exr" \
        --optical-thickness "$thickness" --negative clamp --force
done
name=$(basename "$map" .exr)
build/release/airlight sheet "$map" "out/demo/$name-T0.5.exr" "out/demo/$name-T1.exr" \
    "out/demo/$name-T2.exr" -o out/demo/sheet.png --force

echo "The pictures:"
echo "  $PWD/out/demo/sheet.png (original and optical thickness 0.5, 1, 2)"
for thickness in 0.5 1 2; do echo "  $PWD/out/demo/$name-T$thickness.exr"; done
