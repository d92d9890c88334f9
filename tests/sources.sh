#!/bin/sh
# Every command of docs/sources.md runs, with small pictures and few samples. Arguments: source folder, program.
set -euf
page=$1/docs/sources.md
program=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# A folder of maps for --materials.
mkdir maps
"$program" render builtin:spheres -o maps/Albedo.png --width 16 --height 16 --spp 1 --quiet

# The program, asked for less.
weft() {
    case $1 in
    render) "$program" "$@" --width 32 --height 24 --spp 1 --quiet ;;
    check) "$program" "$@" --quick --no-gpu ;;
    view) "$program" "$@" --width 320 --height 240 --windowless --forget --frames 2 ;;
    plot) "$program" "$@" --quick ;;
    bake) "$program" "$@" --size 4x4 --quiet ;;
    *) "$program" "$@" ;;
    esac
}

# The second column of the tables.
sed -n 's/^| [^|]* | `\(weft .*\)` | .*|$/\1/p' "$page" >commands
rows=$(grep -c '^| .* | ' "$page") # with a heading and no rule for each table
headings=$(grep -c '^| what the source has' "$page")
count=$(wc -l <commands)
[ "$count" -eq $((rows - headings)) ] || {
    echo "sources.md: $count commands in $((rows - headings)) rows"
    exit 1
}
bad=0
while IFS= read -r command; do
    if ! (eval "$command") >out 2>err </dev/null; then
        echo "$command"
        cat err
        bad=1
    fi
done <commands
exit $bad
