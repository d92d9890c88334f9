#!/bin/sh
# The site is made without a warning, of the pages or of the library reference, which asks for a word on every public
# name; it loads nothing from elsewhere. Arguments: source folder.
set -eu
for tool in doxygen sphinx-build; do
    command -v $tool >/dev/null || { echo "skipped: there is no $tool"; exit 77; }
done
cd "$1"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
script/site "$work"
# nothing but links that a reader follows
if grep -rEno '<(script|img|iframe)[^>]*src="(https?:|/)[^"]*|<link[^>]*href="(https?:|/)[^"]*|url\("?(https?:|/)[^)]*' \
    --include='*.html' --include='*.css' "$work"; then
    echo "the site asks for what is elsewhere"
    exit 1
fi
# a page each, in the index of the search, and the words of the headers
find docs -name '*.md' | while read -r page; do
    page=${page#docs/}
    [ -s "$work/${page%.md}.html" ] || { echo "$page: has no page"; exit 1; }
    grep -q "\"${page%.md}\"" "$work/searchindex.js" || { echo "$page: is not found by the search"; exit 1; }
done
# docs/library.md says of each header what is in it
for header in include/weft/*.h; do
    grep -q "[\`/]${header##*/}\`" docs/library.md || { echo "docs/library.md: says nothing of ${header##*/}"; exit 1; }
done
grep -q 'excludes the cosine' "$work/reference/lobe_8h.html"
grep -q 'cannot be opened' "$work/reference/result_8h.html"
