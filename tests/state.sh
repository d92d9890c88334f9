#!/bin/sh
# Each part of the window's state is written by one file, the .c file of the header that declares its record: no other file
# may include view/state/states.h, and a file that does may name no part but its own. Argument: source folder.
set -eu
cd "$1/src/view/state"
bad=0
found() {
    echo "$1"
    bad=1
}

# "PART FILE": the members of struct States, and the file that owns each of them.
owners=$(sed -n '/^struct States {/,/^};/s/^ *\([A-Za-z]*\) \([a-z]*\);$/\1 \2/p' states.h | while read -r type part; do
    header=$(grep -lx "} $type;" ./*.h || true)
    echo "$part $(basename "${header:-nobody}" .h).c"
done)
echo "$owners"
[ "$(echo "$owners" | wc -l)" -ge 9 ] || found "view/state/states.h: parts of the state are missing"
for file in ../*.c ../*/*.c ../*/*.cpp; do
    own=$(echo "$owners" | awk -v file="$(basename "$file")" '$2 == file { print $1 }' | paste -sd '|')
    if ! grep -q '"view/state/states.h"' "$file"; then continue; fi
    [ -n "$own" ] || found "view/$file includes view/state/states.h and owns no part of the state"
    others=$(grep -v '^#include' "$file" | grep -nE 'states(->|\.)[a-z]+' | grep -vE "states(->|\.)(${own:-none})\b" || true)
    [ "$file" = ../viewer.c ] && others=$(echo "$others" | grep -vE '= &states->[a-z]+,' || true)
    [ -z "$others" ] || found "view/$file names a part of the state that is not its own: $others"
done
for part in $(echo "$owners" | awk 'system("ls .. ../* | grep -qx " $2) { print $1 }'); do
    found "no file owns $part of the state"
done
exit $bad
