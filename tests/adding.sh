#!/bin/sh
# Adds to a copy of the sources what docs/adding-a-lobe.md and CONTRIBUTING.md print, and asks the program for it: a lobe,
# a term, a profile, a glTF extension and a verb; and tests/lobes/toy.h as a row, of which the program as it was must say the same by
# --lobe. Then a file without a row must fail shading/registry. Arguments: source folder, C compiler, program. Exit 77:
# skipped.
set -eu
source="$1"
compiler="$2"
before="$3"
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
for part in CMakeLists.txt bench cmake docs include scenes script src study tests; do
    cp -R "$source/$part" "$work/weft/"
done
cd "$work/weft"
listing 1 >src/shading/lobes/minnaert.h
cp tests/lobes/toy.h src/shading/lobes/
sed -i '/^wrap$/a minnaert\ntoy' src/shading/lobes.list
tests/recipes.sh "$source" . >"$work/commands" || { cat "$work/commands"; fail "the recipes do not apply"; }

# Unoptimised, and then with warnings off: gcc 12 sees less then, and warns of more.
cmake -G Ninja -S . -B build -DCMAKE_C_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_C_FLAGS_RELWITHDEBINFO="-O0 -w" -DWEFT_ARRAY_OPTIMIZATION=-O0 -DWEFT_ISA=auto -DWEFT_BENCH=OFF >"$work/log" 2>&1 || { cat "$work/log"; fail "cmake failed"; }
ninja -C build -j2 weft_cli test_shading_registry test_shading_terms test_shading_profiles >"$work/log" 2>&1 || { tail -40 "$work/log"; fail "ninja failed"; }
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

# The commands of the recipes, as they are printed, and what they must show.
mkdir "$work/bin"
ln -s "$work/weft/build/weft" "$work/bin/weft"
mkdir "$work/made"
(cd "$work/made" && PATH="$work/bin:$PATH" sh -e "$work/commands" >"$work/log" 2>&1) ||
    { cat "$work/log"; fail "a command of CONTRIBUTING.md failed"; }
grep -q 'Bidirectional Reflectance Spectroscopy' "$work/log" || fail "weft models v:lommel-seeliger shows no source"
grep -q 'imagined textile mill' "$work/log" || fail "weft models profile:mill shows no page"
grep -q 'Usage: weft mean IMAGE' "$work/log" || fail "weft mean --help shows no usage"
grep -q 'mill' "$work/made/mill.glsl" || fail "weft export mill wrote no shader"
grep -q '"EXT_weft_dyed"' "$work/made/dyed.gltf" || fail "the saved file has no EXT_weft_dyed"
! grep -q 'EXT_weft_dyed.*not supported\|dyed.*means nothing' "$work/log" || fail "the extension is not read"
grep -q 'dyedFactor is 2, but must be in 0 .. 1' "$work/log" || fail "weft doctor does not know the range of dyedFactor"
grep -q 'and as dyedTexture, which is not' "$work/log" || fail "weft doctor does not know the encoding of dyedTexture"
grep -q 'dyed_depth=3' "$work/made/dyed.txt" || fail "the window has no slider of dyed_depth"
for engine in trace raster; do
    for depth in 0 4; do
        weft render "$work/made/dyed.gltf" --engine $engine --width 24 --height 12 --spp 1 \
            --set "*.dyed_depth=$depth" -o "$work/made/$depth.$engine.png" 2>"$work/log" ||
            { cat "$work/log"; fail "weft render --engine $engine dyed.gltf"; }
    done
    ! cmp -s "$work/made/0.$engine.png" "$work/made/4.$engine.png" || fail "dyed_depth changes nothing in $engine"
done
weft --help | grep -q '^  mean ' || fail "weft --help does not list mean"
weft mean "$work/made/term.png" | awk '{ exit !(NF >= 3 && $1 > 0 && $1 < 1) }' || fail "weft mean prints no colour"
# shellcheck disable=SC2046 # four numbers
set -- $(echo 60 0 0 0 | weft eval cook-torrance -p d=blinn-phong -p v=lommel-seeliger -p f=none)
# shellcheck disable=SC2046
near "V by hand, 1 / (4 (cos 60 + 1)), times D of implicit" "$1" \
    "$(set -- $(echo 60 0 0 0 | weft eval cook-torrance -p d=blinn-phong -p v=implicit -p f=none); awk -v x="$1" 'BEGIN { print x * 4 * 0.25 / 1.5 }')"
for name in terms profiles; do
    "build/tests/test_shading_$name" >"$work/log" 2>&1 || { tail -40 "$work/log"; fail "shading/$name does not pass"; }
done

# The toy: as a row, and by --lobe.
near_all() {
    paste "$work/row" "$work/lobe" | awk -v what="$1" '
        { for (k = 1; k <= NF / 2; k++) { d = $k - $(k + NF / 2); if (d * d > 1e-10 * $k * $k + 1e-14) bad = 1 } }
        END { if (bad || !NR) { print what " differs"; exit 1 } }' || fail "the toy as a row and by --lobe"
}
for row in 1 ""; do
    toy() { if [ -n "$row" ]; then build/weft "$@"; else "$before" "$@" --lobe tests/lobes/toy.h; fi; }
    name="$work/${row:+row}"
    [ -n "$row" ] || name="$work/lobe"
    printf '60 0 30 40\n10 20 85 170\n45 0 45 180\n' | toy eval toy -p color=.5,.3,.2 -p roughness=0.2 >"$name"
    printf '0.1\n0.9\n' | toy eval toy --albedo >>"$name"
    toy plot polar toy --json | tr -c '0-9.e\n+-' ' ' | awk 'NF > 20' >>"$name"
    toy check toy --quick --max-albedo 1.001 --max-reciprocity 1e-5 >"$name.check" || fail "weft check toy"
    toy export toy --target glsl -o "$name.glsl" 2>/dev/null
    sed -n '/\*\//,$p' "$name.glsl" >"$name.text"
    for engine in trace raster; do
        toy render builtin:spheres --engine "$engine" --width 24 --height 12 --spp 4 --sheen toy \
            -o "$name.$engine.exr" 2>/dev/null || fail "weft render --engine $engine --sheen toy"
    done
done
near_all "eval or plot"
cmp "$work/row.text" "$work/lobe.text" || fail "the exports of the toy differ"
grep -q 'at most 1 (roughness 0, cos_o 1)' "$work/row.check" && grep -q 'at most 1 (roughness 0, cos_o 1)' "$work/lobe.check" ||
    fail "the passports of the toy differ"
for engine in trace raster; do
    weft diff "$work/row.$engine.exr" "$work/lobe.$engine.exr" --max 1e-6 >"$work/log" || { cat "$work/log"; fail "$engine"; }
done

build/tests/test_shading_registry >"$work/log" 2>&1 || { cat "$work/log"; fail "shading/registry does not take it"; }
cp src/shading/lobes/minnaert.h src/shading/lobes/unlisted.h
if build/tests/test_shading_registry >"$work/log" 2>&1; then fail "shading/registry takes a file without a row"; fi
grep -q 'lobes/unlisted.h has no row in lobes.list' "$work/log" || { cat "$work/log"; fail "and does not say so"; }
