#!/bin/sh
# Follows the recipes of CONTRIBUTING.md in a copy of the tree, up to the build: a file for each listing in C, named in
# the line before, and all changes by patch. Prints the commands of the recipes, a line each. Arguments: source folder,
# and the folder of a copy; without one, src/ and tests/ are copied to a temporary folder.
set -eu
source="$(realpath "$1")"
page="$source/CONTRIBUTING.md"
log="$(mktemp)"
work=
trap 'rm -rf "$log" ${work:+"$work"}' EXIT
if [ $# -gt 1 ]; then
    cd "$2"
else
    work="$(mktemp -d)"
    cp -R "$source/src" "$source/tests" "$work/"
    cd "$work"
fi

files=0
for file in $(grep -oE '`src/[a-z_/]+\.[ch]`:$' "$page" | tr -d '`:'); do
    [ ! -e "$file" ] || { echo "$file: is there already, so that the recipe that adds it adds nothing"; exit 1; }
    awk -v name="\`$file\`:" 'index($0, name) { near = 1 } /^```$/ { if (on) exit; } on; near && /^```c$/ { on = 1 }' "$page" >"$file"
    grep -q '^#pragma once$\|^};$' "$file" || { echo "CONTRIBUTING.md: no listing of $file"; exit 1; }
    files=$((files + 1))
done
[ "$files" = 4 ] || { echo "CONTRIBUTING.md: $files listings, a term, a profile, a formula and a verb expected"; exit 1; }
awk '/^```$/ { on = 0 } on; /^```diff$/ { on = 1 }' "$page" >"$log"
patch -p1 --no-backup-if-mismatch -F 0 <"$log" >"$log.patch" 2>&1 || { cat "$log.patch"; rm -f "$log.patch"; echo "CONTRIBUTING.md: a change does not fit the tree"; exit 1; }
rm -f "$log.patch"
awk '/^## Add a/ { recipe = 1 } /^```$/ { on = 0 } on; recipe && /^```sh$/ { on = 1 }' "$page"
