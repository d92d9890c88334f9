#!/bin/sh
# Runs tests of the Python package by pytest; says so and is skipped where that is not installed. WEFT_PRELOAD names the
# runtime of sanitizers, for an interpreter that has none. Arguments: interpreter, then what pytest takes.
set -eu
python=$1
shift
"$python" -c 'import pytest' 2>/dev/null || {
    echo "skipped: $python has no pytest; Debian's python3-pytest has it"
    exit 77
}
if [ -n "${WEFT_PRELOAD-}" ]; then
    export LD_PRELOAD="$WEFT_PRELOAD" PYTHONMALLOC=malloc ASAN_OPTIONS="${ASAN_OPTIONS-}:detect_leaks=0:allocator_may_return_null=1"
fi
exec "$python" -m pytest -q -rs -p no:cacheprovider "$@"
