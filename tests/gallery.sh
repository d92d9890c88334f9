#!/bin/sh
# Every command of docs/gallery.md writes, in small, the picture that the page shows: the means of red, green and blue
# are within 3 % of the shown one's. Arguments: source folder, program, picture_numbers, folder of the assets.
set -eu
source=$1 program=$2 numbers=$3 assets=$4
page=$source/docs/gallery.md
chair=$assets/gltf/SheenChair
for file in "$assets/gltf/GlamVelvetSofa.glb" "$chair/SheenChair.gltf" "$assets/env/studio_small_03_1k.hdr"; do
    [ -e "$file" ] || { echo "skipped: there is no $file"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cp "$assets/gltf/GlamVelvetSofa.glb" "$assets/env/studio_small_03_1k.hdr" "$chair"/* .

# The program, quiet.
weft() {
    case $1 in
    render) "$program" "$@" --quiet 2>errors || { cat errors; exit 1; } ;;
    *) "$program" "$@" >/dev/null ;;
    esac
}
awk '/^```$/ { on = 0 } on; /^```sh$/ { on = 1 }' "$page" |
    sed 's/--width 800 --height 500 --spp 128/--width 80 --height 50 --spp 16/' >commands # asked for less
grep -q -- '--width 80 ' commands || { echo "$page: the size of pictures is not as it was"; exit 1; }
. ./commands

# r, g and b of a picture.
mean() { "$numbers" "$1" 0 "$2" "$3" | tr ' ' '\n' | sed -n 's/^[rgb]1=\([0-9.]*\).*/\1/p' | tr '\n' ' '; }

pictures=0
for picture in $(grep -o 'pictures/gallery/[a-z-]*\.jpg' "$page"); do
    name=$(basename "$picture" .jpg)
    [ -e "$name.png" ] || { echo "$page: no command writes $name.png"; exit 1; }
    shown=$(mean "$source/docs/$picture" 800 500)
    drawn=$(mean "$name.png" 80 50)
    echo "$name: shown $shown, drawn $drawn"
    echo "$shown $drawn" | awk '{ for (c = 1; c <= 3; c++) if ($c < 0.97 * $(c + 3) || $c > 1.03 * $(c + 3)) exit 1
        exit NF != 6 }' || { echo "$picture is not what its command draws"; exit 1; }
    pictures=$((pictures + 1))
done
[ "$pictures" = 18 ] || { echo "$page: $pictures pictures, 18 expected"; exit 1; }
[ "$pictures" = "$(ls "$source/docs/pictures/gallery" | wc -l)" ] || { echo "a picture is not shown"; exit 1; }
