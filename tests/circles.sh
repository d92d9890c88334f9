#!/bin/sh
# No header of src and include includes itself by way of others. Argument: source folder.
set -eu
cd "$1"
edges="$(mktemp)"
trap 'rm -f "$edges" "$edges.said"' EXIT

# Reads "file:#include "name"" and prints "file included"; a name without a folder is one beside the file.
pairs() {
    sed -nE 's,^(src/|include/)?(.*)/([^/:]+):[ \t]*#[ \t]*include "([^"/]+)".*,\2/\3 \2/\4,p
             s,^(src/|include/)?([^:]+):[ \t]*#[ \t]*include "([^"]+/[^"]+)".*,\2 \3,p'
}

# A circle of the script's own is found, lest it finds none because it reads none.
printf '%s\n' 'src/a/x.h:#include "y.h"' 'src/a/y.h:#include "b/z.h"' 'src/b/z.h:#include "a/x.h"' | pairs >"$edges"
! tsort "$edges" >/dev/null 2>&1 || { echo "a circle of three headers is not found"; exit 1; }

find src include -name '*.h' -exec grep -H '^[ \t]*#[ \t]*include "' {} + | pairs >"$edges"
[ "$(wc -l <"$edges")" -gt 500 ] || { echo "only $(wc -l <"$edges") includes are found"; exit 1; }
tsort "$edges" >/dev/null 2>"$edges.said" || { cat "$edges.said"; exit 1; }
echo "$(wc -l <"$edges") includes of headers, no circle"
