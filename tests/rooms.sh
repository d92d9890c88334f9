#!/bin/sh
# Each room of the window's state is written by the one file that view/state/viewer.h names above it: no other file may include
# view/state/rooms.h, and a file that does may name no room but its own. Argument: source folder.
set -eu
cd "$1/src/view/state"
bad=0
found() {
    echo "$1"
    bad=1
}

# "ROOM FILE": the members of struct Rooms, and the file that the comment above their record begins with.
owners=$(sed -n '/^struct Rooms {/,/^};/s/^ *\([A-Za-z]*\) \([a-z]*\);$/\1 \2/p' rooms.h | while read -r type room; do
    file=$(sed -n "/^typedef struct $type {/{x;p;q;};h" viewer.h | sed -n 's,^/\* \([a-z_]*\.c\): .*,\1,p')
    echo "$room ${file:-nobody}"
done)
echo "$owners"
[ "$(echo "$owners" | wc -l)" -ge 9 ] || found "view/state/rooms.h: rooms are missing"
for file in ../*.c ../*/*.c ../*/*.cpp; do
    own=$(echo "$owners" | awk -v file="$(basename "$file")" '$2 == file { print $1 }' | paste -sd '|')
    if ! grep -q '"view/state/rooms.h"' "$file"; then continue; fi
    [ -n "$own" ] || found "view/$file includes view/state/rooms.h and owns no room"
    others=$(grep -v '^#include' "$file" | grep -nE 'rooms(->|\.)[a-z]+' | grep -vE "rooms(->|\.)(${own:-none})\b" || true)
    [ "$file" = ../viewer.c ] && others=$(echo "$others" | grep -vE '= &rooms->[a-z]+,' || true)
    [ -z "$others" ] || found "view/$file names a room that is not its own: $others"
done
for room in $(echo "$owners" | awk '$2 == "nobody" || system("ls .. ../* | grep -qx " $2) { print $1 }'); do found "no file owns the room $room"; done
exit $bad
