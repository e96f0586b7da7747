#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Bakes a mesh on a Slurm cluster: an array job for each pass of light that bounces, and a merge
# behind it, AIRLIGHT_THREADS processors for each part (1 without it). docs/farm.md tells more. Run again with the same arguments, it does what is missing.
set -eu

if [ $# -lt 4 ]; then
    echo "Usage: slurm_bake.sh PARTS BOUNCES OUT.prt MESH [FLAGS of airlight bake, but --bounces]" >&2
    exit 2
fi
parts=$1 bounces=$2 out=$3
shift 3

threads=${AIRLIGHT_THREADS:-1}
directory=$out.farm
mkdir -p "$directory"
bake=$(printf '%q ' airlight bake "$@" --bounces "$bounces")
after=() before=
for ((pass = 0; pass <= bounces; ++pass)); do
    name=$(printf '%q' "$directory/pass$pass")
    merged=$name.prt
    [ "$pass" -lt "$bounces" ] || merged=$(printf '%q' "$out")
    # A part appears when it is whole, so one that is there is done. exec: signals are the bake's.
    array=$(sbatch --parsable --job-name=bake --requeue --open-mode=append \
        --cpus-per-task="$threads" --array="1-$parts" \
        --output="$directory/pass$pass-%a.log" ${after[@]+"${after[@]}"} \
        --wrap "part=$name-part\$SLURM_ARRAY_TASK_ID.prt
if [ -e \"\$part\" ] || [ -e $merged ]; then exit; fi
exec $bake--pass $pass $before--shard \$SLURM_ARRAY_TASK_ID/$parts -o \"\$part\" \
--threads $threads")
    merge=$(sbatch --parsable --job-name=merge --requeue --open-mode=append \
        --output="$directory/pass$pass-merge.log" --dependency="afterok:$array" --wrap "
if [ -e $merged ]; then exit; fi
airlight merge $name-part*.prt -o $merged && rm $name-part*.prt")
    after=(--dependency="afterok:$merge") before="--before $merged "
    echo "pass $pass: array job $array, then merge job $merge"
done
