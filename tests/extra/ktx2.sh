#!/bin/sh
# Compares the texels of KTX 2 files, made by weft and by an encoder from npm, with those of the transcoder that three.js
# has, bit for bit: tests/extra/ktx2.sh PROGRAM KTX2_TEXELS FOLDER. Fetches both into FOLDER with npm.
set -eu
program=$(realpath "$1")
texels=$(realpath "$2")
here=$(cd "$(dirname "$0")" && pwd)
for tool in node npm; do
    command -v "$tool" >/dev/null || {
        echo "weft: $tool is not here: script/install node" >&2
        exit 4
    }
done
mkdir -p "$3/ktx2"
cd "$3/ktx2"
[ -d node_modules/ktx2-encoder ] || npm install --silent --no-save --prefix . three@0.187.0 ktx2-encoder@0.6.0
rm -rf files
mkdir files
cp "$here/ktx2.mjs" .
node ktx2.mjs make files
for picture in files/*.tga; do
    "$program" convert "$picture" --data --quiet -o "${picture%.tga}-weft.ktx2"
done
find files -name '*.ktx2' -exec "$texels" {} + 2>refused.txt
node ktx2.mjs compare files
