#!/bin/sh
# Has stock three.js and stock Babylon.js in headless Chromium draw balls with sheen and with fuzz under one stated light, in
# linear floats, and `weft judge` say which program drew each picture, and by which term it departs:
# tests/extra/judge.sh PROGRAM FOLDER. Fetches both into FOLDER with npm.
set -eu
program=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
. "$here/browser.sh"
for tool in node npm chromium jq; do
    command -v "$tool" >/dev/null || {
        echo "weft: $tool is not here: script/install node browser" >&2
        exit 4
    }
done
mkdir -p "$2/judge"
cd "$2/judge"
[ -d node_modules/babylonjs-loaders ] ||
    npm install --silent --no-save --prefix . three@0.187.0 babylonjs@9.35.0 babylonjs-loaders@9.28.0
cp "$here"/judge* .
node judge.mjs files
for engine in three babylon; do
    browse 480 judge-$engine.html --use-angle=swiftshader --enable-unsafe-swiftshader --allow-file-access-from-files
    kill "$browser" 2>/dev/null || true
    mv chromium.log $engine.log
done
node judge.mjs pictures three.log babylon.log
wrong=0
# Judges PICTURE, drawn of FILE, and expects the engine and the term that are named, with that share each.
expect() {
    picture=$1 file=$2 engine=$3 term=$4 share=$5
    "$program" judge "$file" "$picture.npy" --no-shadows --spp 16 --quiet --json >verdict.json 2>verdict.txt && {
        echo "$picture: nothing is off FAILED"
        wrong=1
        return
    }
    said=$(jq -r '.pictures[0].causes[0].name, ([.pictures[0].causes[] | select(.kind == "term")][0] | .name, .share)' \
        verdict.json | tr '\n' ' ')
    first=$(jq '.pictures[0].causes[0].share' verdict.json)
    printf '%s: %s%s of the engine' "$picture" "$said" "$first"
    jq -e --arg engine "$engine" --arg term "$term" --argjson share "$share" '.pictures[0].causes as $c
        | ([$c[] | select(.kind == "term")][0]) as $t
        | $c[0].name == $engine and $c[0].share > 0.99 and $t.name == $term and $t.share > $share' verdict.json \
        >/dev/null && echo || {
        echo ' FAILED'
        wrong=1
    }
}
expect three sheen.gltf three sheen-v-neubelt 0.9
expect babylon sheen.gltf babylon sheen-v-neubelt 0.9
expect babylon-openpbr fuzz.gltf babylon-openpbr fuzz-at-half 0.9
exit $wrong
