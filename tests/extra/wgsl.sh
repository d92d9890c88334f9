#!/bin/sh
# Compiles every text of WGSL in headless Chromium, by WebGPU on its software driver, and holds what each answers against
# the library: tests/extra/wgsl.sh QUESTIONS FOLDER, where QUESTIONS is the program tests/export/wgsl_questions.c.
set -eu
questions=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
. "$here/browser.sh"
command -v chromium >/dev/null || {
    echo "weft: chromium is not here: script/install browser" >&2
    exit 4
}
mkdir -p "$2/wgsl"
cd "$2/wgsl"
cp "$here/wgsl.html" .
"$questions" >models.js
browse 300 wgsl.html --enable-unsafe-webgpu --enable-features=Vulkan,WebGPU --use-webgpu-adapter=swiftshader
sed -n 's/.*CONSOLE[^"]*"\(.*\)", source.*/\1/p' chromium.log >report.txt
if grep FAILED report.txt; then exit 1; fi
[ "$(grep -c 'answers within' report.txt)" -gt 50 ] || {
    echo "weft: too few answers: $PWD/report.txt" >&2
    exit 1
}
echo "$(grep -c 'answers within' report.txt) texts answer as the library does, $(grep -c compiles report.txt) more compile"
