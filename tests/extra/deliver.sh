#!/bin/sh
# Delivers materials and assets, has stock viewers in headless Chromium draw the files without a word in the console, and
# holds what they draw against weft's truth, column by column: tests/extra/deliver.sh PROGRAM FOLDER [THING ...]. Viewers
# and things are in deliver/table.mjs; the viewers come into FOLDER with npm. A sample asset is looked for in WEFT_DATA.
set -eu
program=$(realpath "$1")
folder=$2
here=$(cd "$(dirname "$0")" && pwd)
data=$(realpath "${WEFT_DATA:-$here/../../../shared/data}" 2>/dev/null || true)
. "$here/browser.sh"
for tool in node npm chromium; do
    command -v "$tool" >/dev/null || {
        echo "weft: $tool is not here: script/install node browser" >&2
        exit 4
    }
done
shift 2
[ $# -gt 0 ] || set -- velvet denim gabardine spheres chair
mkdir -p "$folder/deliver"
cd "$folder/deliver"
cp "$here"/deliver/* .
packages=$(node -e 'import("./table.mjs").then(t => console.log(Object.values(t.viewers).flatMap(v => v.packages).join(" ")))')
# shellcheck disable=SC2086 # the packages are words
[ -d node_modules/filament ] || npm install --silent --no-save --prefix . $packages
"$program" render builtin:spheres --preset velvet --save spheres.glb
if [ -e "$data/gltf/SheenChair" ]; then
    cp -f "$data"/gltf/SheenChair/* .
    mv -f SheenChair.gltf chair.gltf
else
    echo "skipped: chair, since there is no gltf/SheenChair in WEFT_DATA"
    # shellcheck disable=SC2046 # the things are words
    set -- $(printf '%s\n' "$@" | grep -vx chair)
fi
rm -rf files
node prepare.mjs "$program" "$@"
for viewer in three babylon filament; do
    browse 360 "page.html?$viewer" --use-angle=swiftshader --enable-unsafe-swiftshader --allow-file-access-from-files
    kill "$browser"
    wait "$browser" || true
    mv chromium.log "$viewer.log"
done
node compare.mjs "$@"
