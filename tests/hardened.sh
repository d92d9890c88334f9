#!/bin/sh
# The program and the library are bound when they start, with tables that are then read-only; functions that read bytes from
# outside look at a word behind their arrays and at the sizes of buffers. Arguments: program, library. Exit 77: skipped.
set -eu
command -v readelf >/dev/null || {
    echo "skipped: there is no readelf"
    exit 77
}
for file; do
    readelf -dW "$file" | grep -q BIND_NOW || { echo "$file: symbols are bound as they are called"; exit 1; }
    readelf -lW "$file" | grep -q GNU_RELRO || { echo "$file: its tables can be written"; exit 1; }
    readelf -lW "$file" | grep GNU_STACK | grep -q 'RW ' || { echo "$file: its stack can be run"; exit 1; }
    for symbol in __stack_chk_fail '__[a-z]*_chk'; do
        readelf -sW "$file" | grep -q "UND $symbol" || { echo "$file: does not call $symbol"; exit 1; }
    done
done
readelf -hW "$1" | grep -q 'DYN' || { echo "$1: cannot be loaded anywhere"; exit 1; }
