#!/bin/sh
# The library reference: Doxygen finds nothing in include/weft that is not explained. Arguments: source folder.
set -eu
command -v doxygen >/dev/null || { echo "skipped: there is no doxygen"; exit 77; }
cd "$1"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
{ cat docs/Doxyfile && echo "OUTPUT_DIRECTORY = $work"; } | doxygen -
# what a reader would look for is there, with its words
grep -q 'without the cosine\|excludes the cosine' "$work/html/lobe_8h.html"
grep -q 'cannot be opened' "$work/html/result_8h.html"
for call in weft_lobe_eval weft_bake weft_render_create; do grep -rq "$call" "$work/html/globals_func.html"; done
