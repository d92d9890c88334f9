#!/bin/sh
# Saves every built-in scene, and one in every preset, as .glb and .gltf, mends and delivers some, and has the Khronos
# validator find no error in them, and not even a warning in what is delivered: tests/extra/validate.sh PROGRAM FOLDER.
# Fetches the validator into FOLDER with npm.
set -eu
program=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
for tool in node npm; do
    command -v "$tool" >/dev/null || {
        echo "weft: $tool is not here: script/install node" >&2
        exit 4
    }
done
mkdir -p "$2"
cd "$2"
[ -d node_modules/gltf-validator ] || npm install --silent --no-save --prefix . gltf-validator@2.0.0-dev.3.10
rm -rf saved delivered
mkdir saved
for scene in cloth sewing spheres; do
    "$program" render "builtin:$scene" --save "saved/$scene.glb" --save "saved/$scene.gltf"
done
for preset in "$here"/../../scenes/presets/*.json; do
    preset=$(basename "$preset" .json)
    "$program" render builtin:cloth --preset "$preset" --save "saved/$preset.glb" --save "saved/$preset.gltf"
done
"$program" render builtin:spheres --set '*.clearcoat=0.5' --set '*.anisotropy=0.5' --set '*.emission=2' \
    --texture "*.nap=$here/../../examples/nap/nap.png" --texture "*.base_color=$here/../../examples/nap/nap.png" \
    --light 'sun;-1,-2,-1;3,3,3' --light 'spot;0,5,0;0,-1,0;9,9,9;20,20' --light 'point;1,2,3;20,1,1' \
    --save saved/everything.glb --save saved/everything.gltf
# What the doctor mends is as good: of each kind of file into each.
for name in everything.glb everything.gltf cloth.glb velvet.gltf; do
    for kind in glb gltf; do # exit 1: something is left that is no error of the file
        "$program" doctor "saved/$name" --fix -o "saved/mended-${name%.*}-${name##*.}.$kind" >/dev/null || [ $? = 1 ]
    done
done
for source in saved/everything.glb saved/velvet.gltf preset:woven-denim preset:woven-linen 'satin 8/3'; do
    "$program" deliver "$source" --to khronos,three,babylon,filament,blender,core -o delivered --width 32 --spp 1 --size 64 \
        >/dev/null
done
node "$here/validate.mjs" saved/*.glb saved/*.gltf
node "$here/validate.mjs" --strict delivered/*.glb
