#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Installs, builds, fogs a real environment map and bakes a mesh: out/demo gets three EXRs, a contact
# sheet of them, and pictures of meshes that the clear and the foggy map light.
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

# What the vertices of the mesh see, baked once; then any map lights it.
lit="out/demo/knot.png"
build/release/airlight bake data/knot.ply -o out/demo/knot.prt --tolerance 0.01 --force
build/release/airlight sheet "$map" "out/demo/$name-T1.exr" --prt out/demo/knot.prt \
    --mesh data/knot.ply --view 185,20 --tile-width 640 -o out/demo/knot.png --force
bunny=/usr/share/glmark2/models/bunny.obj
if [ -r "$bunny" ]; then
    build/release/airlight bake "$bunny" -o out/demo/bunny.prt --ground -0.99 --force
    build/release/airlight sheet "$map" "out/demo/$name-T1.exr" --prt out/demo/bunny.prt \
        --mesh "$bunny" --view 20,14 --tile-width 640 -o out/demo/bunny.png --force
    lit="$lit out/demo/bunny.png"
fi

echo "The pictures:"
echo "  $PWD/out/demo/sheet.png (original and optical thickness 0.5, 1, 2)"
for picture in $lit; do echo "  $PWD/$picture (a baked mesh, lit by the clear and a foggy map)"; done
for thickness in 0.5 1 2; do echo "  $PWD/out/demo/$name-T$thickness.exr"; done
