#!/bin/sh
# Opens the report page of `weft plot` in headless Chromium without a network: it must ask for nothing, say nothing
# on the console and show every picture. tests/extra/report.sh PROGRAM FOLDER
set -eu
program=$(realpath "$1")
command -v chromium >/dev/null || {
    echo "weft: chromium is not here: script/install browser" >&2
    exit 4
}
mkdir -p "$2"
cd "$2"
rm -rf report
mkdir report
cd report
"$program" plot report fibre charlie-neubelt:alpha=0.25 -o report.html
pictures=$(grep -o '<img ' report.html | wc -l)

# There is no script in the page. One copy gets one, which says what was fetched and what is to be seen; another
# asks for a picture from elsewhere, and must be noticed.
asking='<script>onload = () => {
    const shown = [...document.images].filter(i => i.complete && i.naturalWidth > 200).length;
    const fetched = performance.getEntriesByType("resource").filter(r => !r.name.startsWith("data:")).length;
    document.title = "shown " + shown + " fetched " + fetched;
}</script></body></html>'
sed -e "s|default-src 'none'|default-src 'none'; script-src 'unsafe-inline'|" -e '/^<\/body>/d' report.html >asked.html
echo "$asking" >>asked.html
sed 's|</body>|<img src="http://elsewhere.invalid/a.png" alt=""></body>|' report.html >spoiled.html

browse() {
    timeout 240 chromium --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking \
        --host-resolver-rules='MAP * ~NOTFOUND' --user-data-dir="$PWD/profile" --enable-logging=stderr \
        --virtual-time-budget=10000 "$2" "file://$PWD/$1.html" >"$1.out" 2>"$1.err"
}
fail() {
    echo "weft: report.html: $1" >&2
    exit 1
}
browse report --screenshot="$PWD/report.png"
browse asked --dump-dom
browse spoiled --dump-dom
grep -q CONSOLE spoiled.err || fail "the browser does not tell what a page asks for"
if grep -h CONSOLE report.err asked.err; then fail "the browser's console is not empty"; fi
grep -q "<title>shown $pictures fetched 0</title>" asked.out || fail "does not show its $pictures pictures, or fetches"
[ "$(wc -c <report.png)" -gt 20000 ] || fail "the screen is empty"
rm -rf profile
echo "report.html: $pictures pictures shown, nothing fetched, nothing said"
