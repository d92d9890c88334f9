#!/bin/sh
# Installs the build into an empty prefix and builds examples/albedo against it, by CMake package and by pkg-config.
# Arguments: build folder, source folder.
set -eu
build="$1"
source="$2"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cmake -G Ninja -S "$source/examples/albedo" -B "$work/cmake" -DCMAKE_PREFIX_PATH="$work/prefix" >/dev/null
cmake --build "$work/cmake" >/dev/null
PKG_CONFIG_PATH="$(dirname "$(find "$work/prefix" -name weft.pc)")"
export PKG_CONFIG_PATH
# shellcheck disable=SC2046
cc "$source/examples/albedo/albedo.c" -o "$work/albedo" $(pkg-config --cflags --libs weft)
LD_LIBRARY_PATH="$(pkg-config --variable=libdir weft)"
export LD_LIBRARY_PATH
"$work/cmake/albedo" >"$work/by-cmake"
"$work/albedo" >"$work/by-pkg-config"
cmp "$work/by-cmake" "$work/by-pkg-config"
grep -q 'cos 1.0  E 0.03125' "$work/by-cmake"
"$work/prefix/bin/weft" --version >/dev/null # finds its library beside it
for header in "$work"/prefix/include/weft/*.h; do # every public header stands alone, in C and in C++
    printf '#include "%s"\n' "$header" >"$work/one.c"
    cp "$work/one.c" "$work/one.cpp"
    cc -std=c11 -Wall -Wextra -Wpedantic -Werror -I"$work/prefix/include" -fsyntax-only "$work/one.c"
    if command -v c++ >/dev/null; then
        c++ -std=c++17 -Wall -Wextra -Werror -I"$work/prefix/include" -fsyntax-only "$work/one.cpp"
    fi
done
nm -D --defined-only "$(find "$work/prefix" -name libweft.so)" | awk '$2 == "T" && $3 !~ /^weft_/ { print; bad = 1 } END { exit bad }'
