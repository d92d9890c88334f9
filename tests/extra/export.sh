#!/bin/sh
# Draws exported Shadertoys in headless Chromium and compiles every ESSL text there:
# tests/extra/export.sh PROGRAM FOLDER. Leaves FOLDER/export.png, the picture of the two terms side by side.
set -eu
program=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
for tool in chromium jq; do
    command -v "$tool" >/dev/null || {
        echo "weft: $tool is not here: script/install browser" >&2
        exit 4
    }
done
mkdir -p "$2/export"
cd "$2/export"
cp "$here/export.html" .
rm -f ./*.toy ./*.essl
"$program" export ashikhmin-neubelt charlie-neubelt --target shadertoy --quiet -o sides
for model in $("$program" models --json | jq -r '(.lobes, .profiles, .workflows)[].id' | grep -v -e '^none$' -e '^fibre-walk$'); do
    "$program" export "$model" --target shadertoy --quiet -o "$model.toy"
    "$program" export "$model" --target essl --lut npy --quiet -o "$model.essl"
done
texts() { for file in ./*."$1"; do jq -Rs --arg name "${file#./}" '{($name): .}' "$file"; done | jq -s add; }
{
    printf 'const texts = {sides: '
    jq -Rs . sides
    printf ', toys: '
    texts toy
    printf ', essl: '
    texts essl
    printf '};\n'
} >texts.js
browser() {
    timeout 600 chromium --headless --no-sandbox --disable-gpu-sandbox --use-gl=angle --use-angle=swiftshader \
        --enable-unsafe-swiftshader --hide-scrollbars --virtual-time-budget=250000 "$@" 2>chromium.log
}
browser --dump-dom "file://$PWD/export.html" >report.html
browser --window-size=960,540 --screenshot="$PWD/../export.png" "file://$PWD/export.html?picture" >/dev/null
sed -n '/<pre/,/<\/pre>/p' report.html >report.txt
grep FAILED report.txt && exit 1
grep -q 'all done' report.txt || {
    echo "weft: the browser did not finish: $PWD/chromium.log" >&2
    exit 1
}
echo "$(grep -c '^ok\|>ok' report.txt) answers of the browser, and $(realpath ..)/export.png"
