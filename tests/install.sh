#!/bin/sh
# Installs the build into an empty prefix, builds the examples against it alone, and looks at what they say.
# Arguments: build folder, source folder.
set -eu
build="$1"
source="$2"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
PKG_CONFIG_PATH="$(dirname "$(find "$work/prefix" -name weft.pc)")"
export PKG_CONFIG_PATH
# shellcheck disable=SC2046
cc "$source/examples/albedo/albedo.c" -o "$work/by-hand" $(pkg-config --cflags --libs weft)
LD_LIBRARY_PATH="$(pkg-config --variable=libdir weft)"
PATH="$work/prefix/bin:$PATH"
export LD_LIBRARY_PATH PATH
for example in "$source"/examples/*/CMakeLists.txt; do # a copy, so that nothing else of the sources is near
    name=$(basename "$(dirname "$example")")
    cp -r "$(dirname "$example")" "$work/$name"
    cmake -G Ninja -S "$work/$name" -B "$work/$name/build" -DCMAKE_PREFIX_PATH="$work/prefix" \
        -DCMAKE_C_FLAGS="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror" >/dev/null
    cmake --build "$work/$name/build" >"$work/log" || { cat "$work/log"; exit 1; }
done

# one number, by either way of building
"$work/albedo/build/albedo" >"$work/by-cmake"
"$work/by-hand" >"$work/by-pkg-config"
cmp "$work/by-cmake" "$work/by-pkg-config"
grep -q 'cos 1.0  E 0.03125' "$work/by-cmake"

# the program of docs/library.md
awk '/^```/ { code = /^```c$/; next } code' "$source/docs/library.md" >"$work/page.c"
# shellcheck disable=SC2046
cc -std=c11 -Wall -Wextra -Werror "$work/page.c" -o "$work/page" $(pkg-config --cflags --libs weft)
"$work/page" | grep -Eq '^f [0-9.]+  pdf [0-9.]+$'

# all strategies of the renderer find the same light
for strategy in mis light lobe; do "$work/renderer/build/renderer" "$work/$strategy.png" 96 64 $strategy; done |
    awk '{ print; mean[NR] = $NF } END { for (k = 2; k <= 3; k++) if (mean[k] / mean[1] > 1.01 || mean[k] / mean[1] < 0.99) exit 1
        exit !(mean[1] > 0.1) }'
weft diff "$work/mis.png" "$work/light.png" --max 0.1 >/dev/null

# the table is E
"$work/table/build/table" charlie-neubelt "$work/e.npy" 16 >/dev/null
weft bake audit "$work/e.npy" --lobe charlie-neubelt --axes cos,alpha,centres --max 1e-3 >/dev/null

# a lamp by tables is the lamp by points, through the exported text
"$work/opengl/build/velvet" "$work/tables.png"
"$work/opengl/build/velvet" "$work/points.png" 8
weft diff "$work/tables.png" "$work/points.png" --max 1e-3 >/dev/null

# denim of one point a pixel has the light of denim of sixteen, near and from afar
"$work/weave/build/denim" "$work/one.png" 1
"$work/weave/build/denim" "$work/sixteen.png" 16
weft diff "$work/one.png" "$work/sixteen.png" --max 0.2 >/dev/null

# the Python package that was installed finds the library that was installed
PYTHONPATH="$work/prefix/lib/python3/dist-packages" python3 -c 'import weft; print(weft.version(), weft.__file__)' |
    grep -q "$work/prefix/lib/python3"

env -u LD_LIBRARY_PATH "$work/prefix/bin/weft" --version >/dev/null # finds its library beside it
for header in "$work"/prefix/include/weft/*.h; do # every public header stands alone, in C and in C++
    printf '#include "%s"\n' "$header" >"$work/one.c"
    cp "$work/one.c" "$work/one.cpp"
    cc -std=c11 -Wall -Wextra -Wpedantic -Werror -I"$work/prefix/include" -fsyntax-only "$work/one.c"
    if command -v c++ >/dev/null; then
        c++ -std=c++17 -Wall -Wextra -Werror -I"$work/prefix/include" -fsyntax-only "$work/one.cpp"
    fi
done
nm -D --defined-only "$(find "$work/prefix" -name libweft.so)" | awk '$2 == "T" && $3 !~ /^weft_/ { print; bad = 1 } END { exit bad }'
