# Shows a page in headless Chromium until it has said "all done" in its console, whose lines are in chromium.log:
# browse SECONDS PAGE OPTION... To be sourced. Virtual time would not wait for a GPU.
browse() {
    limit=$1 page=$2 seconds=0
    shift 2
    true >chromium.log # before it is looked at
    chromium --headless --no-sandbox "$@" --user-data-dir="$PWD/profile" --enable-logging=stderr "file://$PWD/$page" \
        >/dev/null 2>chromium.log &
    browser=$!
    trap 'kill $browser 2>/dev/null || true' EXIT
    until grep -q '"all done"' chromium.log; do
        kill -0 $browser 2>/dev/null && [ $((seconds += 1)) -lt "$limit" ] || {
            echo "weft: the browser did not finish: $PWD/chromium.log" >&2
            exit 1
        }
        sleep 1
    done
}
