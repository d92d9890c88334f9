#!/bin/sh
# slurm.sh WEFT [inside]: gives a queue of Slurm on this machine alone (script/queue) a picture: the bytes of one run. Skipped where no
# queue starts; inside one already by the second word.
set -eu
weft=$1
if [ -z "${2-}" ]; then
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    trap 'exit 1' INT TERM
    chmod 755 "$work"
    "$(dirname "$0")/../script/queue" "$work" "$0" "$weft" inside
    exit
fi
cd "$(dirname "$SLURM_CONF")"
job="builtin:spheres --width 120 --height 90 --spp 48"
"$weft" render $job --quiet -o whole.exr -o whole.png
"$weft" farm slurm --array 3 --program "$weft" -- render $job -o "a cloth.exr" -o cloth.png >job.sh
sh job.sh --chdir="$PWD" >numbers
tries=0
while [ -n "$(squeue -h)" ]; do
    tries=$((tries + 1))
    [ $tries -le 240 ] || { squeue; tail -n 5 ./*.log; exit 1; }
    sleep 0.5
done
cmp whole.exr "a cloth.exr"
cmp whole.png cloth.png
echo "jobs $(tr '\n' ' ' <numbers): an array of 3 parts and the merge have the bytes of one run"
