#!/bin/sh
# Delivers materials and a draft, has stock three.js in headless Chromium draw the files without a word in the console, and
# holds what it draws against weft's reference, column by column: tests/extra/deliver.sh PROGRAM FOLDER. Fetches three.js
# into FOLDER with npm.
set -eu
program=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
. "$here/browser.sh"
for tool in node npm chromium; do
    command -v "$tool" >/dev/null || {
        echo "weft: $tool is not here: script/install node browser" >&2
        exit 4
    }
done
mkdir -p "$2/deliver"
cd "$2/deliver"
[ -d node_modules/three ] || npm install --silent --no-save --prefix . three@0.187.0
cp "$here/deliver.html" .
rm -rf files
# Each line: a name, a material, and how far its columns may be off.
cases='velvet preset:velvet 0.1
denim preset:woven-denim 0.1'
bounds=
echo 'window.files = {};' >files.js
while read -r name material most; do
    "$program" deliver "$material" --to three -o files --name "$name" --width 64 --spp 4 >/dev/null
    "$program" render builtin:bend --preset "${material#preset:}" --env 0 --background transparent --max-depth 1 \
        --light 'sun;-1,-0.4,-1;3,3,3' --camera '0.12,0.08,0.9;0,0,0;16' --width 160 --height 120 --spp 256 --quiet \
        -o "$name.npy"
    printf 'window.files["%s"] = "%s";\n' "$name" "$(base64 -w 0 "files/$name-three.glb")" >>files.js
    bounds="$bounds $name=$most"
done <<END
$cases
END
browse 180 deliver.html --use-angle=swiftshader --enable-unsafe-swiftshader --allow-file-access-from-files
# shellcheck disable=SC2086 # the bounds are words
node "$here/deliver.mjs" chromium.log $bounds
