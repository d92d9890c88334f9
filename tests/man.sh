#!/bin/sh
# The manual pages: one a verb, with all its options, and nothing in them that man or mandoc would warn of.
# Arguments: source folder, program.
set -eu
for tool in mandoc man; do
    command -v $tool >/dev/null || { echo "skipped: there is no $tool"; exit 77; }
done
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
"$1/script/man" "$2" "$work"
for verb in $("$2" --help | sed -n '/^  0 /q; s/^  \([a-z][a-z]*\) .*/\1/p'); do
    page="$work/weft-$verb.1"
    mandoc -Tutf8 "$page" | sed "s,.\x08,,g" >"$work/text"
    for option in $("$2" "$verb" --help | grep -o '^  -[-a-z]*'); do
        grep -q -e "^ *$option\( \|$\)" "$work/text" || { echo "weft-$verb.1: says nothing of $option"; exit 1; }
    done
done
for page in "$work"/*.1; do
    {
        mandoc -Tlint -Wwarning "$page" | grep -v 'missing date' || true # a page depends on the version alone
        LC_ALL=C.UTF-8 man --warnings=all -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 >/dev/null
    } | tee "$work/warnings"
    [ ! -s "$work/warnings" ]
done
