#!/bin/sh
# Adds the lobe of docs/adding-a-lobe.md to a copy of the sources, by one file and one row as that page says, and asks
# the program for it. Then a second file, without a row, must fail shading/registry.
# Arguments: source folder, C compiler. Exit 77: skipped.
set -eu
source="$1"
compiler="$2"
for tool in "$compiler" cmake ninja; do
    if ! command -v "$tool" >/dev/null; then
        echo "skipped: there is no $tool"
        exit 77
    fi
done
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
fail() {
    echo "$*" >&2
    exit 1
}

# Listing number $1 in C.
page="$source/docs/adding-a-lobe.md"
listing() { awk -v n="$1" '/^```$/ { on = 0 } on; /^```c$/ { on = ++k == n }' "$page"; }

mkdir "$work/weft"
for part in CMakeLists.txt bench cmake docs include scenes script src tests; do
    cp -R "$source/$part" "$work/weft/"
done
cd "$work/weft"
listing 1 >src/shading/lobes/minnaert.h
sed -i '/^wrap$/a minnaert' src/shading/lobes.list

# Unoptimised, and then with warnings off: gcc 12 sees less then, and warns of more.
cmake -G Ninja -S . -B build -DCMAKE_C_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_C_FLAGS_RELWITHDEBINFO="-O0 -w" -DWEFT_ARRAY_OPTIMIZATION=-O0 >"$work/log" 2>&1 || { cat "$work/log"; fail "cmake failed"; }
ninja -C build -j2 weft_cli test_shading_registry >"$work/log" 2>&1 || { tail -40 "$work/log"; fail "ninja failed"; }
weft() { build/weft "$@"; }

# near WHAT NUMBER EXPECTED
near() {
    awk -v x="$2" -v y="$3" 'BEGIN { d = (x - y) / y; exit !(x != "" && d * d < 1e-10) }' || fail "$1: $2, expected $3"
}
weft models minnaert | grep -q 'how fast the edge darkens' || fail "weft models minnaert does not know it"
weft models | grep -q '^  minnaert ' || fail "weft models does not list it"
# shellcheck disable=SC2046 # four numbers
set -- $(echo 60 0 0 0 | weft eval minnaert -p k=2)
near "f, 3 / (2 pi) cos 60" "$1" 0.23873241
near "pdf, 3 / (2 pi)" "$4" 0.47746483
near "E, cos_o^(k - 1)" "$(echo 0.25 | weft eval minnaert -p k=2 --albedo)" 0.25
weft check minnaert --quick --max-albedo 1.001 --max-reciprocity 1e-5 >"$work/passport" ||
    { cat "$work/passport"; fail "weft check minnaert failed"; }
picture() { weft render builtin:spheres --width 24 --height 12 --spp 1 -o "$work/$1.png" "$2" "$3" 2>/dev/null; }
picture plain --sheen lambert
for kind in sheen diffuse; do
    picture "$kind" --$kind minnaert || fail "weft render --$kind minnaert failed"
    ! cmp -s "$work/plain.png" "$work/$kind.png" || fail "weft render --$kind minnaert changes nothing"
done
script/docs build/weft >"$work/log"
grep -q 'Minnaert, The reciprocity principle' docs/lobes/minnaert.md || fail "script/docs made no page"

build/tests/test_shading_registry >"$work/log" 2>&1 || { cat "$work/log"; fail "shading/registry does not take it"; }
cp src/shading/lobes/minnaert.h src/shading/lobes/unlisted.h
if build/tests/test_shading_registry >"$work/log" 2>&1; then fail "shading/registry takes a file without a row"; fi
grep -q 'lobes/unlisted.h has no row in lobes.list' "$work/log" || { cat "$work/log"; fail "and does not say so"; }
