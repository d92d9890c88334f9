#!/bin/sh
# Every command of docs/sources.md shows what its row says, in small pictures: tests/sources.txt has a check for each row.
# Arguments: source folder, program, picture_numbers.
set -euf
page=$1/docs/sources.md
checks=$1/tests/sources.txt
program=$2
numbers=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
width=64 height=48

# Folders of maps and of a cubemap, all of them green, and a script of keys.
"$program" render builtin:ball -o green.png --width 16 --height 16 --spp 1 --quiet --camera '0,9,0;0,20,0;20' \
    --background 0.05,0.6,0.05 --tonemap none
mkdir -p maps Models/Materials/0 cube
cp green.png maps/Albedo.png
cp green.png Models/Materials/0/Albedo.png
for face in posx negx posy negy posz negz; do cp green.png "cube/$face.png"; done
echo 'wait rest' >rest.txt
printf 'wait rest\nkeydown shift\nkeydown w\nwait 10\nkeyup w\nkeyup shift\nwait rest\n' >walk.txt

# The program, asked for less, and for numbers.
weft() {
    case $1 in
    render) "$program" "$@" --width $width --height $height --spp 16 --quiet --json ;;
    check) "$program" "$@" --quick --no-gpu ;;
    view)
        case "$*" in
        *--script*) "$program" "$@" --json --width 320 --height 240 --windowless --forget ;;
        *) "$program" "$@" --json --script rest.txt --width 320 --height 240 --windowless --forget ;;
        esac
        ;;
    plot)
        case "$*" in
        *' sphere '* | 'plot sphere'*) "$program" "$@" --quick ;;
        *) "$program" "$@" --quick --csv ;;
        esac
        ;;
    bake) "$program" "$@" --size 4x4 --quiet ;;
    *) "$program" "$@" ;;
    esac
}

says() { cat out err | grep -qF -e "$*"; }
has() {
    file=$1
    shift
    grep -qaF -e "$*" "$file"
}

# awk's expression of the numbers of a picture is true.
holds() {
    awk "BEGIN { $2; exit !($1) }" || {
        echo "$2"
        return 1
    }
}
draws() { holds 'span1 > 0.05 && y1 > 0.01' "$("$numbers" "$1" 0 0 0)"; }
plots() {
    for model in "$@"; do
        awk -F, -v m="$model" 'index($0, m) && $NF > 0 { n++ } END { exit !(n > 3) }' out || return 1
    done
}
views() { grep -q '"shows":"drawn"' out; }
walks() { [ "$(grep -o '"eye":\[[^]]*\]' out | sort -u | wc -l)" -gt 1 ]; }
shows() {
    picture=$(sed -n 's/^  *"\([^"]*\.png\)".*/\1/p' out | head -1)
    columns=$(grep -c '"outputs"' out)
    [ "$columns" -gt 1 ] && sheet=$columns || sheet=0
    values=$("$numbers" "$picture" "$sheet" $width $height | tr '\n' ';')
    [ -n "$values" ] || return 1
    for k in $(seq "$columns"); do values="$values s$k=(span$k > 0.02 && mid$k > 0.01 && rim$k > 0.01);"; done
    values="$values $(sed -n 's/^ *"mean": \([0-9.e-]*\),*$/\1/p' out | awk '{ printf "d%d = %s; ", NR, $1 }')"
    holds "($1) $(for k in $(seq "$columns"); do printf ' && s%d' "$k"; done)" "$values"
}

# The tables' rows: first and second column.
sed -n 's/^| \([^|]*\) | `\([^`]*weft .*\)` | .*|$/\1\t\2/p' "$page" >rows
count=$(wc -l <rows)
lines=$(grep -c '^| .* | ' "$page") # with a heading and no rule for each table
headings=$(grep -c '^| what the source has' "$page")
[ "$count" -eq $((lines - headings)) ] || {
    echo "sources.md: $count commands in $((lines - headings)) rows"
    exit 1
}
grep -v '^#' "$checks" | cut -f1 >checked
cut -f1 rows | diff - checked || {
    echo "sources.txt: its rows are not those of sources.md"
    exit 1
}
bad=0

# A black ball passes no check of a picture.
weft render builtin:ball -o black.png --set ball.base_color=0 --set ball.specular=0 --set ball.sheen=0 >out
if shows 'y1 >= 0' >/dev/null; then
    echo "a black ball passes"
    bad=1
fi

tab=$(printf '\t')
grep -v '^#' "$checks" | cut -f2 >tests
paste rows tests >all
while IFS="$tab" read -r row command check; do
    if ! (eval "$command") >out 2>err </dev/null; then
        echo "$row: $command"
        cat err
        bad=1
        continue
    fi
    kind=${check%% *}
    rest=${check#"$kind"}
    rest=${rest# }
    case $kind in
    says | shows) "$kind" "$rest" ;;
    *) eval "$check" ;;
    esac || {
        echo "$row: $command: does not hold: $check"
        bad=1
    }
done <all
exit $bad
