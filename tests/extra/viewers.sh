#!/bin/sh
# Delivers woven cloths, has stock viewers draw them, and puts what they drew beside what weft draws, the picture of
# docs/deliver.md: tests/extra/viewers.sh PROGRAM FOLDER OUT.jpg. Which cloths: deliver/table.mjs.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=$(realpath "$3")
. "$here/browser.sh"
things=$(cd "$here/deliver" && node -e 'import("./table.mjs").then(t => console.log(t.gallery.things.join(" ")))')
# shellcheck disable=SC2086 # the things are words
"$here/deliver.sh" "$1" "$2" $things
cd "$2/deliver"
node montage.mjs
browse 60 montage.html --allow-file-access-from-files
sed -n 's/.*"JPEG \([^"]*\)".*/\1/p' chromium.log | base64 -d >"$out"
