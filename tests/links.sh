#!/bin/sh
# Every relative link of the pages leads to a file that is there, and to a heading in it. Arguments: source folder.
set -eu
cd "$1"

# "PAGE TARGET" of every link that is not in code.
links() {
    find README.md CONTRIBUTING.md docs bench scenes src study -name '*.md' | sort | while read -r page; do
        awk -v page="$page" '
            /^ *```/ { code = !code }
            code { next }
            { gsub(/`[^`]*`/, "")
              while (match($0, /\]\([^) ]+\)/)) {
                  print page, substr($0, RSTART + 2, RLENGTH - 3)
                  $0 = substr($0, RSTART + RLENGTH)
              } }' "$page"
    done | grep -Ev ' (https?|mailto):'
}

# What the headings of a page are called in links.
anchors() {
    awk '/^ *```/ { code = !code } !code && sub(/^#+ /, "") { print tolower($0) }' "$1" | sed 's/[^a-z0-9 _-]//g; s/ /-/g'
}

# The index leads to every page that is beside it.
for page in docs/*.md; do
    name=$(basename "$page")
    [ "$name" = index.md ] || grep -q "]($name)" docs/index.md || {
        echo "docs/index.md: has no link to $name"
        exit 1
    }
done

links >/dev/null # fails where there are none
links | {
    bad=0
    while read -r page target; do
        file=$page
        [ "${target%%#*}" = "" ] || file=$(dirname "$page")/${target%%#*}
        if [ ! -e "$file" ]; then
            echo "$page: $target: is not there"
            bad=1
        elif [ "$target" != "${target#*#}" ] && ! anchors "$file" | grep -qx -e "${target#*#}"; then
            echo "$page: $target: has no such heading"
            bad=1
        fi
    done
    exit $bad
}
